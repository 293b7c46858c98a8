/* Pantin for Arduino: a face that shows emotes by name, blinks and glances by itself, and speaks.
 *
 *     #include <PantinFace.h>
 *     #include <pantin_face_data.h>                       // the cartoon and 23 emotes: include it in one file
 *
 *     PantinFace face;
 *     face.begin(pantin_cartoon, sizeof pantin_cartoon, 240, 240);
 *     face.emotes(pantin_emotes, PANTIN_EMOTES);
 *     face.emote("happy");
 *     if (face.update(millis())) face.draw(sprite);
 *
 * For 32-bit processors: an ESP32, an ESP8266, an RP2040, a SAMD. All memory is in the object, 3 KB. */
#ifndef PANTIN_FACE_ARDUINO_H
#define PANTIN_FACE_ARDUINO_H

#include "pantin_face.h"
#include "pantin_talk.h"

/* A face of at most VertexCount vertices: the cartoon has 97, the wireframe 239. Emotes have at most ChannelCount channels: ours 7. */
template <uint16_t VertexCount = 97, uint16_t ChannelCount = 12> class PantinFaceOf {
  public:
    /* Opens a model for a display of `width` times `height` pixels. Returns false if it is damaged or has more vertices. */
    bool begin(const uint8_t *model, uint32_t length, uint16_t width, uint16_t height) {
        uint32_t rate = talk.rate ? talk.rate : 16000;
        ready = pantin_face_open(&face, model, length, memory, sizeof memory) == PANTIN_OK && pantin_face_size(&face, width, height) == PANTIN_OK;
        running = false;
        if (ready) pantin_face_live(&face, 1);
        return ready && pantin_talk_open(&talk, rate) == PANTIN_OK;
    }

    /* Lends a list of emotes. */
    bool emotes(const pantin_emote *list, uint16_t count) { return pantin_face_emotes(&face, list, count) == PANTIN_OK; }

    /* Goes over to an emote in 0.3 s. Returns false if the list has no such name: the face stays as it is. */
    bool emote(const char *name) { return pantin_face_emote(&face, name) == PANTIN_OK; }

    /* Sets a unit of the face, such as "smile_left", from 0 to 1, in addition to the emote. Returns false if the model has no such name. */
    bool weight(const char *name, float value) {
        return pantin_face_weight(&face, name, static_cast<int32_t>(value * static_cast<float>(PANTIN_FACE_FULL))) == PANTIN_OK;
    }

    /* Turns the eyes: from -1 to 1, to the right of the picture and up. */
    bool look(float right, float up) {
        return pantin_face_look(&face, static_cast<int32_t>(right * 32768.0f), static_cast<int32_t>(up * 32768.0f)) == PANTIN_OK;
    }

    /* Blinks and glances at times that `seed` chooses; 0 ends it. */
    bool live(uint32_t seed) { return pantin_face_live(&face, seed) == PANTIN_OK; }

    /* Sets the colours of 16 brightnesses, the background first, in RGB565. The array is not copied. */
    bool palette(const uint16_t *colors) { return pantin_face_palette(&face, colors) == PANTIN_OK; }

    /* Sets the rate of the sound that follows, 8000 to 48000 Hz: 16000 without a call. Returns false for another. With a rate that is not the sound's own
     * the lips move, but wrongly. */
    bool soundRate(uint32_t rate) {
        pantin_talk other;
        if (pantin_talk_open(&other, rate) != PANTIN_OK) return false;
        talk = other;
        return true;
    }

    /* Moves the lips by sound: before each update(), all samples that were played or recorded since the last one. */
    void sound(const int16_t *samples, size_t count) { pantin_talk_push(&talk, samples, count); }

    /* Shows a viseme of MPEG-4, 1 to 14, or none, 0, `ms` milliseconds from now until the next one's time; visemes win over sound. Returns false for another
     * number, a time before that of one that waits, and if 16 wait already. */
    bool viseme(uint8_t number, uint32_t ms) { return pantin_talk_viseme(&talk, number, talk.now + ms) == PANTIN_OK; }

    /* Lets time pass: pass millis(). Returns true if 33 ms or more have passed since the last picture: draw it then. */
    bool update(uint32_t now) {
        if (!ready) return false;
        if (!running) last = now - 33;
        running = true;
        uint32_t elapsed = now - last;
        if (elapsed < 33) return false;
        last = now;
        uint16_t ms = static_cast<uint16_t>(elapsed > 1000 ? 33 : elapsed);
        pantin_talk_step(&talk, ms);
        for (uint8_t i = 1; i <= PANTIN_TALK_VISEMES; i++) pantin_face_viseme(&face, i, talk.weights[i - 1]);
        pantin_face_speaking(&face, talk.speaking);
        return pantin_face_step(&face, ms) == PANTIN_OK;
    }

    /* Draws the picture on a cleared display or sprite of Adafruit_GFX, TFT_eSPI, M5GFX (M5Canvas) or Arduino_GFX with 16-bit colours. */
    template <class Display> void draw(Display &display) {
        Target<Display> target = {&display, face.palette};
        if (ready) pantin_face_spans(&face, colored<Display>, &target, 0, face.height);
    }

    /* The same in one colour, for displays of 1 bit; U8g2 takes no colour. */
    template <class Display> void drawLit(Display &display) {
        if (ready) pantin_face_spans(&face, lit<Display>, &display, 0, face.height);
    }

    /* Draws rows y0 to y1 - 1 into a buffer of `stride` bytes a row. PANTIN_RGB565_SWAPPED is what SPI displays take. */
    bool rows(pantin_face_format format, void *buffer, size_t stride, uint16_t y0, uint16_t y1) {
        return ready && pantin_face_draw(&face, format, buffer, stride, y0, y1) == PANTIN_OK;
    }

    pantin_face face = pantin_face();
    pantin_talk talk = pantin_talk();

  private:
    /* What spans are drawn on. */
    template <class Display> struct Target {
        Display *display;
        const uint16_t *palette;
    };

    /* The colours that pantin_face_draw has in RGB565. */
    static uint16_t color(uint32_t shade, const uint16_t *palette) {
        if (palette) return palette[shade >> 4];
        return static_cast<uint16_t>((255 * shade) >> 11 << 11 | (236 * shade) >> 10 << 5 | (205 * shade) >> 11);
    }

    template <class Display> static void colored(void *context, uint16_t x, uint16_t y, uint16_t count, uint8_t shade) {
        Target<Display> *target = static_cast<Target<Display> *>(context);
        target->display->drawFastHLine(x, y, count, color(shade, target->palette));
    }

    template <class Display> static void lit(void *context, uint16_t x, uint16_t y, uint16_t count, uint8_t shade) {
        line(*static_cast<Display *>(context), x, y, count, shade != 0, 0);
    }

    template <class Surface>
    static auto line(Surface &d, uint16_t x, uint16_t y, uint16_t count, bool on, int) -> decltype(d.drawFastHLine(x, y, count, 1), void()) {
        d.drawFastHLine(x, y, count, on ? 1 : 0);
    }
    template <class Surface> static void line(Surface &d, uint16_t x, uint16_t y, uint16_t count, bool on, long) {
        d.setDrawColor(on ? 1 : 0);
        d.drawHLine(x, y, count);
    }

    uint32_t memory[PANTIN_FACE_WORDS(VertexCount, ChannelCount)];
    uint32_t last;
    bool ready = false, running = false;
};

/* The cartoon, and any model of at most as many vertices. */
typedef PantinFaceOf<> PantinFace;

#endif
