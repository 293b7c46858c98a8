// A display for the voice assistant xiaozhi-esp32: a face that shows the emotions of the server, listens, and speaks. README.md describes how to add it
// to a board.
#ifndef PANTIN_DISPLAY_H
#define PANTIN_DISPLAY_H

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "display/lcd_display.h"
#include "lv_pantin.h"

// The display class of the firmware that drives the panel: SpiLcdDisplay, RgbLcdDisplay, MipiLcdDisplay, or a class that derives from one of them.
#ifndef PANTIN_DISPLAY_BASE
#define PANTIN_DISPLAY_BASE SpiLcdDisplay
#endif

// Samples that wait for the lips, a power of two: 4096 samples are 170 ms at 24 kHz and take 8 KB.
#ifndef PANTIN_DISPLAY_SAMPLES
#define PANTIN_DISPLAY_SAMPLES 4096
#endif

class PantinDisplay : public PANTIN_DISPLAY_BASE {
public:
    // Takes the parameters of the base class.
    using PANTIN_DISPLAY_BASE::PANTIN_DISPLAY_BASE;
    ~PantinDisplay() override;

    // Adds the face to the base class's user interface: above the emoji, below the bars with texts and icons. If the lock of LVGL is not available, or
    // LVGL has no memory, there is no face, and the log has an error. All other functions work without a face.
    void SetupUI() override;

    // Shows an emotion from the next picture on, and returns at once. A name without an emote, such as that of an icon, shows `neutral`, and the log has
    // a warning.
    void SetEmotion(const char* emotion) override;

    // Shows `listening` while the status is Lang::Strings::LISTENING, and the last emotion otherwise. The base class shows the text.
    void SetStatus(const char* status) override;

    // Moves the lips by samples of one channel that are played from now on, at `sample_rate` Hz, 8,000 to 48,000. Call it from one task: the one that
    // writes to the audio codec. That task must not wait, and LVGL's task holds LVGL's lock while it draws a picture. So this function takes no lock. It
    // copies the samples into a buffer, which a timer of LVGL empties at the rate of playing. Samples that find no room in the buffer are dropped: lips
    // then miss that part of the sound.
    void PlayedPcm(const int16_t* samples, size_t count, int sample_rate);

private:
    static void OnTimer(lv_timer_t* timer);
    void ShowEmote();
    void MoveLips();

    lv_obj_t* face_ = nullptr;
    lv_timer_t* timer_ = nullptr;

    // Written by the task that calls SetEmotion and SetStatus, read by LVGL's.
    std::atomic<const char*> emotion_{"neutral"};
    std::atomic<bool> listening_{false};
    const char* shown_ = nullptr;

    // A queue from the audio task to LVGL's. Positions count samples and wrap around.
    int16_t samples_[PANTIN_DISPLAY_SAMPLES];
    std::atomic<uint32_t> written_{0};
    std::atomic<uint32_t> read_{0};
    std::atomic<int> rate_{0};
    uint32_t lips_rate_ = 0;     // the rate of the widget in Hz; 0 if it does not support rate_
    int known_rate_ = 0;         // the last value of rate_ that MoveLips() has seen
    uint32_t last_tick_ = 0;
    uint32_t milli_samples_ = 0; // thousandths of a sample that are due
};

// An audio codec that passes what it plays to a display: `Codec` is the class of the firmware that the board uses.
template <class Codec>
class PantinCodec : public Codec {
public:
    using Codec::Codec;

    void SetDisplay(PantinDisplay* display) { display_ = display; }

    void OutputData(std::vector<int16_t>& data) override {
        if (display_ != nullptr) {
            display_->PlayedPcm(data.data(), data.size(), this->output_sample_rate());
        }
        Codec::OutputData(data);
    }

private:
    PantinDisplay* display_ = nullptr;
};

#endif
