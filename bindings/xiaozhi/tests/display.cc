/* PantinDisplay on LVGL's test display: emotions, statuses, lips, memory, and a lock that is not available.
 *
 *     display PICTURES : writes RGB565 pictures of 240 by 240, one for each of the 21 emotions and one of the status LISTENING */
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <thread>
#include <vector>

#include <esp_log.h>

#include "assets/lang_config.h"
#include "pantin_display.h"

#define NEED(held) Need(held, #held, __LINE__)

namespace {

constexpr int kSize = 240;
constexpr int kRate = 24000;
constexpr int kBlockMs = 60; /* the firmware's blocks of sound */
constexpr int kEmoteMs = 700;
constexpr double kTurn = 2 * 3.14159265358979;

/* The emotions of the firmware. */
const char* const kEmotions[] = {"neutral",   "happy",   "laughing", "funny",    "sad",     "angry",     "crying", "loving",    "embarrassed", "surprised", "shocked",
                                 "thinking", "winking", "cool",     "relaxed",  "delicious", "kissy",  "confident", "sleepy",    "silly",     "confused"};
constexpr size_t kCount = sizeof kEmotions / sizeof *kEmotions;
static_assert(kCount == 21);

typedef std::vector<uint16_t> Picture;

void Need(bool held, const char* what, int line) {
    if (held) return;
    printf("line %d failed: %s\n", line, what);
    exit(1);
}

size_t Used() {
    lv_mem_monitor_t monitor;
    lv_mem_monitor(&monitor);
    return monitor.total_size - monitor.free_size;
}

Picture Shown() {
    const lv_draw_buf_t* buffer = lv_display_get_buf_active(lv_display_get_default());
    Picture picture;
    for (int y = 0; y < kSize; y++) {
        const uint16_t* row = reinterpret_cast<const uint16_t*>(buffer->data + y * buffer->header.stride);
        picture.insert(picture.end(), row, row + kSize);
    }
    return picture;
}

/* The face of the only PantinDisplay. */
lv_obj_t* FaceObject() {
    for (uint32_t i = 0; i < lv_obj_get_child_count(lv_screen_active()); i++) {
        lv_obj_t* child = lv_obj_get_child(lv_screen_active(), static_cast<int32_t>(i));
        if (lv_obj_check_type(child, &lv_pantin_class)) return child;
    }
    return nullptr;
}

/* Whether the face plays the clip of the emote with this name. */
bool Plays(const char* name) {
    const pantin_face* face = lv_pantin_get_face(FaceObject());
    for (uint16_t i = 0; i < face->emote_count; i++) {
        if (strcmp(face->emotes[i].name, name) == 0) return face->playing && face->source.window == face->emotes[i].bytes;
    }
    return false;
}

/* How far visemes move the mouth, in thousandths. */
uint32_t Opening() {
    uint64_t sum = 0;
    for (uint16_t weight : lv_pantin_get_face(FaceObject())->visemes) sum += weight;
    return static_cast<uint32_t>(sum * 1000 / PANTIN_TALK_FULL);
}

/* An audio codec of the firmware: the parts that PantinCodec uses. */
class Codec {
public:
    explicit Codec(int rate) : rate_(rate) {}
    virtual ~Codec() {}
    virtual void OutputData(std::vector<int16_t>& data) { played_ += data.size(); }
    int output_sample_rate() const { return rate_; }
    size_t played() const { return played_; }

private:
    int rate_;
    size_t played_ = 0;
};

/* A vowel: pulses of 120 Hz through resonances at 700 and 1,200 Hz. */
class Voice {
public:
    int16_t Next() {
        double sample = phase_ < 120 ? 1 : 0;
        phase_ = (phase_ + 120) % kRate;
        sample = Resonate(0, 700, sample) + Resonate(1, 1200, sample);
        return static_cast<int16_t>(std::clamp(sample * 4000, -32000.0, 32000.0));
    }

private:
    double Resonate(int which, double hz, double in) {
        double* last = last_[which];
        double out = in + 2 * 0.985 * cos(kTurn * hz / kRate) * last[0] - 0.985 * 0.985 * last[1];
        last[1] = last[0];
        last[0] = out;
        return out;
    }
    int phase_ = 0;
    double last_[2][2] = {};
};

/* A voice for the first `voiced_ms` of `ms`, then silence. */
std::vector<int16_t> Sound(Voice& voice, int voiced_ms, int ms) {
    std::vector<int16_t> samples;
    for (int i = 0; i < kRate / 1000 * ms; i++) samples.push_back(i < kRate / 1000 * voiced_ms ? voice.Next() : int16_t{0});
    return samples;
}

PantinDisplay* NewDisplay() { return new PantinDisplay(nullptr, nullptr, kSize, kSize, 0, 0, false, false, false); }

/* Shows an emotion until its transition is over. */
Picture Show(PantinDisplay& display, const char* emotion) {
    display.SetEmotion(emotion);
    lv_test_wait(kEmoteMs);
    return Shown();
}

void Emotions(PantinDisplay& display, FILE* pictures) {
    std::vector<Picture> all;
    for (const char* emotion : kEmotions) {
        Picture picture = Show(display, emotion);
        NEED(Plays(emotion));
        for (const Picture& other : all) NEED(picture != other);
        fwrite(picture.data(), sizeof picture[0], picture.size(), pictures);
        all.push_back(picture);
    }
    Picture before = Shown();
    for (size_t i = kCount; i < 50; i++) {
        const char* emotion = kEmotions[i * 8 % kCount];
        Picture picture = Show(display, emotion);
        NEED(Plays(emotion) && picture != before);
        before = picture;
    }
    NEED(log_lines == 0);
    printf("50 changes of emotion, %u pictures that differ\n", static_cast<unsigned>(all.size()));
}

void UnknownEmotions(PantinDisplay& display) {
    int lines = log_lines;
    for (const char* emotion : {"microchip_ai", static_cast<const char*>(nullptr)}) {
        Show(display, "happy");
        NEED(Plays("happy"));
        Show(display, emotion);
        NEED(Plays("neutral") && log_lines == ++lines);
        NEED(strstr(log_line, emotion != nullptr ? emotion : "NULL") != nullptr);
    }
}

void Status(PantinDisplay& display, const char* status, const char* emote) {
    display.SetStatus(status);
    lv_test_wait(kEmoteMs);
    NEED(Plays(emote) && strcmp(lv_label_get_text(display.status_label()), status) == 0);
}

void Statuses(PantinDisplay& display, FILE* pictures) {
    Show(display, "happy");
    Status(display, Lang::Strings::STANDBY, "happy");
    Status(display, Lang::Strings::CONNECTING, "happy");
    Status(display, Lang::Strings::LISTENING, "listening");
    Picture picture = Shown();
    if (pictures != nullptr) fwrite(picture.data(), sizeof picture[0], picture.size(), pictures);
    /* The firmware sets this emotion at the beginning of listening; the server's comes before the answer. */
    Show(display, "neutral");
    NEED(Plays("listening"));
    Show(display, "sad");
    NEED(Plays("listening"));
    Status(display, Lang::Strings::SPEAKING, "sad");
    Status(display, "12:30", "sad");
    display.SetChatMessage("assistant", "Hello");
    display.ShowNotification(std::string("Volume 50"));
    NEED(strcmp(lv_label_get_text(display.status_label()), "Volume 50") == 0);
    Show(display, "neutral");
}

/* 60 s of syllables: 300 ms of voice, 200 ms of silence; after every eighth one 2 s of silence. */
void Speech(PantinDisplay& display) {
    PantinCodec<Codec> codec(kRate);
    codec.SetDisplay(&display);
    Voice voice;
    std::vector<int16_t> sound;
    std::vector<int> starts;
    while (sound.size() < 60u * kRate) {
        starts.push_back(static_cast<int>(sound.size() / (kRate / 1000)));
        for (int16_t sample : Sound(voice, 300, starts.size() % 8 == 0 ? 2500 : 500)) sound.push_back(sample);
    }
    sound.resize(60u * kRate);
    std::vector<uint32_t> openings; /* every 10 ms */
    for (size_t i = 0; i < sound.size(); i += kRate / 1000 * kBlockMs) {
        std::vector<int16_t> block(sound.begin() + static_cast<long>(i), sound.begin() + static_cast<long>(std::min(sound.size(), i + kRate / 1000 * kBlockMs)));
        codec.OutputData(block);
        for (int ms = 0; ms < kBlockMs; ms += 10) {
            lv_test_wait(10);
            openings.push_back(Opening());
        }
    }
    NEED(codec.played() == sound.size());
    uint32_t least_open = 1000, most_closed = 0;
    for (int start : starts) {
        auto from = openings.begin() + start / 10;
        least_open = std::min(least_open, *std::max_element(from + 10, from + 30));
        most_closed = std::max(most_closed, *std::min_element(from + 40, from + 50));
    }
    printf("60 s of speech, %u syllables: the mouth opens to at least %u thousandths, and closes to at most %u between them\n",
           static_cast<unsigned>(starts.size()), least_open, most_closed);
    NEED(starts.size() == 80 && least_open > 400 && most_closed < 50);
    /* After the end the emote has the mouth again. */
    lv_test_wait(1000);
    NEED(Opening() == 0 && lv_pantin_get_face(FaceObject())->speaking == 0);
}

/* The lips follow a block that is written at once in the time in which it is played. */
void Pace(PantinDisplay& display) {
    Voice voice;
    Picture closed = Shown();
    std::vector<int16_t> silence(kRate / 1000 * 80), vowel = Sound(voice, 80, 80);
    silence.insert(silence.end(), vowel.begin(), vowel.end());
    display.PlayedPcm(silence.data(), silence.size(), kRate);
    lv_test_wait(70);
    NEED(Opening() == 0);
    lv_test_wait(100);
    NEED(Opening() > 300 && Shown() != closed);
    lv_test_wait(1000);
    NEED(Opening() == 0);
    /* More than the buffer takes: the rest is dropped. */
    std::vector<int16_t> second = Sound(voice, 1000, 1000);
    display.PlayedPcm(second.data(), second.size(), kRate);
    lv_test_wait(100);
    NEED(Opening() > 300);
    lv_test_wait(PANTIN_DISPLAY_SAMPLES * 1000 / kRate + 300);
    NEED(Opening() == 0);
    /* A rate that the lips do not support. */
    int lines = log_lines;
    display.PlayedPcm(second.data(), second.size(), 4000);
    lv_test_wait(100);
    NEED(log_lines == lines + 1 && Opening() == 0);
    display.PlayedPcm(second.data(), 100, kRate);
    lv_test_wait(400);
}

/* Tasks that set emotions and play sound while LVGL's task draws. */
void Tasks(PantinDisplay& display) {
    std::atomic<bool> ends{false};
    Voice voice;
    std::vector<int16_t> block = Sound(voice, 100, 160);
    std::thread audio([&] {
        while (!ends) {
            display.PlayedPcm(block.data(), block.size(), kRate);
            std::this_thread::yield();
        }
    });
    std::thread application([&] {
        for (size_t i = 0; !ends; i++) {
            display.SetEmotion(kEmotions[i % kCount]);
            std::this_thread::yield();
        }
    });
    uint32_t most_open = 0;
    for (int i = 0; i < 100; i++) {
        lv_test_wait(20);
        most_open = std::max(most_open, Opening());
    }
    ends = true;
    audio.join();
    application.join();
    NEED(most_open > 300);
    Show(display, "neutral");
    NEED(Plays("neutral"));
    lv_test_wait(1000);
}

/* Without the lock, nothing of LVGL is touched: with it, each call gives it back. */
void Locks() {
    Voice voice;
    std::vector<int16_t> block = Sound(voice, kBlockMs, kBlockMs);
    LcdDisplay::lock_fails = true;
    PantinDisplay* display = NewDisplay();
    int lines = log_lines;
    display->SetupUI();
    NEED(FaceObject() == nullptr && log_lines == lines + 1);
    display->SetEmotion("happy");
    display->SetStatus(Lang::Strings::LISTENING);
    for (int i = 0; i < 10; i++) display->PlayedPcm(block.data(), block.size(), kRate);
    lv_test_wait(100);
    delete display;
    LcdDisplay::lock_fails = false;
    display = NewDisplay();
    display->SetupUI();
    lv_test_wait(100);
    LcdDisplay::lock_fails = true;
    Show(*display, "sad");
    NEED(Plays("sad"));
    display->SetStatus(Lang::Strings::LISTENING);
    lv_test_wait(kEmoteMs);
    NEED(Plays("listening"));
    for (int i = 0; i < 4; i++) {
        display->PlayedPcm(block.data(), block.size(), kRate);
        lv_test_wait(kBlockMs);
    }
    NEED(Opening() > 300);
    LcdDisplay::lock_fails = false;
    delete display;
    NEED(FaceObject() == nullptr && LcdDisplay::locked == 0);
}

/* The face lies above the emoji and below the texts. */
void Order(PantinDisplay& display) {
    int32_t face = lv_obj_get_index(FaceObject());
    NEED(lv_obj_get_index(display.emoji_box()) < face && face < lv_obj_get_index(display.status_label()));
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    FILE* pictures = fopen(argv[1], "wb");
    if (pictures == nullptr) return 2;
    lv_init();
    lv_display_set_color_format(lv_test_display_create(kSize, kSize), LV_COLOR_FORMAT_RGB565);
    lv_obj_set_style_text_color(lv_screen_active(), lv_color_white(), 0);
    /* The screen and the display keep lists once they had objects. */
    Locks();
    size_t before = Used();
    PantinDisplay* display = NewDisplay();
    display->SetupUI();
    lv_test_wait(100);
    Order(*display);
    /* Equal emotions give equal pictures. */
    pantin_face_live(lv_pantin_get_face(FaceObject()), 0);
    log_lines = 0;
    Statuses(*display, nullptr);
    size_t warm = Used();
    Emotions(*display, pictures);
    UnknownEmotions(*display);
    Statuses(*display, pictures);
    fclose(pictures);
    Speech(*display);
    Pace(*display);
    Tasks(*display);
    Statuses(*display, nullptr);
    printf("%u bytes of LVGL's memory after the warm-up, %u at the end\n", static_cast<unsigned>(warm), static_cast<unsigned>(Used()));
    NEED(Used() == warm && LcdDisplay::locked == 0);
    delete display;
    NEED(Used() == before);
    return 0;
}
