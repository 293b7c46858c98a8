/* Pantin for Arduino: a character that the state machine of a bank moves, by inputs such as buttons.
 *
 *     #include "hero.h"                                    // written by: pantin expand hero.ptb -o hero.h
 *     PantinCharacter<BANK_HERO_CHANNELS> hero;
 *     PantinInput go;
 *     hero.begin(BANK_HERO, BANK_HERO_LEN);
 *     go = hero.input("go");
 *     hero.hold(go, digitalRead(BUTTON) == LOW);
 *     if (hero.update(millis())) body.draw(hero, display, rows, 16);   // a PantinSolid
 *
 * For 32-bit processors. All memory is in the object. The bank is read from flash. */
#ifndef PANTIN_CHARACTER_ARDUINO_H
#define PANTIN_CHARACTER_ARDUINO_H

#include "PantinPlayer.h"
#include "pantin_feet.h"
#include "pantin_solid.h"

/* An input or a parameter, found once. False if the machine has no such name. */
class PantinInput {
  public:
    PantinInput() : index(PANTIN_NO_INPUT) {}
    explicit PantinInput(uint8_t found) : index(found) {}
    explicit operator bool() const { return index != PANTIN_NO_INPUT; }
    uint8_t index;
};

/* Feet that are held, or not: a character without them has none of their code. */
template <bool HoldsFeet> struct PantinHeldFeet {
    pantin_feet memory;
    pantin_result lend(pantin_character *character) { return pantin_character_feet(character, &memory); }
};
template <> struct PantinHeldFeet<false> {
    pantin_result lend(pantin_character *) { return PANTIN_NOT_FOUND; }
};

/* A character whose rig has at most ChannelCount channels, whose machine has at most LayerCount layers (0: they do not play), and whose feet are held if
 * the bank has a table of them. */
template <uint16_t ChannelCount, uint8_t LayerCount = 1, bool HoldsFeet = true> class PantinCharacter {
  public:
    /* Opens a bank with a state machine, in its first state at the origin. Returns false if it is damaged, has no machine, or has more channels or layers:
     * error() says which. */
    bool begin(const uint8_t *bytes, uint32_t length) {
        uint8_t without = static_cast<uint8_t>((LayerCount ? 0 : PANTIN_WITHOUT_LAYERS) | (HoldsFeet ? 0 : PANTIN_WITHOUT_FEET));
        pantin_animator_memory lent = {own.moving, ChannelCount, own.values, own.pose, offsets, ChannelCount, groups, ChannelCount};
        memory = lent;
        ready = running = stopped = false;
        result = pantin_character_open(&character, content.open(bytes, length), &memory, without);
        if (result == PANTIN_OK) {
            result = pantin_character_second(&character, &secondTrack, second.moving, ChannelCount, second.values, ChannelCount);
        }
        if (LayerCount) lendLayers();
        if (result == PANTIN_OK && HoldsFeet) {
            pantin_result held = feet.lend(&character);
            if (held != PANTIN_NOT_FOUND) result = held;
        }
        ready = result == PANTIN_OK;
        return ready;
    }

    /* Lets time pass: pass millis(). Returns true if there is a pose to draw: false before begin(), while it is stopped, and after an error of a clip. */
    bool update(uint32_t now) {
        if (!ready) return false;
        uint32_t elapsed = running ? now - last : 0;
        last = now;
        running = true;
        if (stopped) return false;
        /* After a long pause the motion goes on where it was. */
        if (elapsed > 1000) elapsed = 0;
        result = pantin_character_update(&character, elapsed * 10u * percent);
        return result == PANTIN_OK;
    }

    /* What the last begin() or update() returned: of enum pantin_result in pantin.h. */
    pantin_result error() const { return result; }

    /* Finds an input or a parameter: once, in setup(). The result is false if the machine has no such name. */
    PantinInput input(const char *name) const { return PantinInput(ready ? pantin_character_input(&character, name) : PANTIN_NO_INPUT); }
    PantinInput parameter(const char *name) const { return PantinInput(ready ? pantin_character_parameter(&character, name) : PANTIN_NO_INPUT); }

    /* Fires an input, which the next update alone sees; holds it down or lets it go; sets a parameter, within its range. Returns false if there is none. */
    bool press(PantinInput input) {
        if (ready && input) pantin_character_fire(&character, input.index);
        return ready && input;
    }
    bool hold(PantinInput input, bool down) {
        if (ready && input) pantin_character_hold(&character, input.index, down);
        return ready && input;
    }
    bool set(PantinInput parameter, int16_t value) {
        if (ready && parameter) pantin_character_set(&character, parameter.index, value);
        return ready && parameter;
    }

    /* Whether the machine is in the state of this name, and whether the last update entered a state. */
    bool in(const char *state) const { return ready && pantin_character_state(&character, state) == character.state; }
    bool entered() const { return ready && character.entered; }

    /* Copies the name of the state, at most `room` - 1 bytes of it and a 0. Returns false, and an empty name, if there is none. */
    bool stateName(char *into, size_t room) const {
        pantin_name name;
        if (room) *into = 0;
        if (!ready || !room || !pantin_character_state_name(&character, character.state, &name)) return false;
        pantin_copy_name(&name, into, room);
        return true;
    }

    /* Whether the last update passed an event of this name, such as "left_foot_down", of the clip that plays now. */
    bool event(const char *name) const {
        if (!ready) return false;
        for (uint8_t i = 0; i < character.animator.event_count; i++) {
            const pantin_fired &fired = character.animator.events[i];
            pantin_event event;
            pantin_name called;
            pantin_first_event(&event, &character.animator.track.clip);
            while (pantin_next_event(&event)) {
                if (event.id != fired.id || event.frame != fired.frame) continue;
                if (pantin_event_name(&character.animator.track.clip, event.id, &called) && pantin_name_is(&called, name)) return true;
            }
        }
        return false;
    }

    /* Where the character is, in centimetres from where it began: z and x for a rig whose y is up. Returns false, and leaves `cm`, before begin(). */
    bool place(float (&cm)[2]) const {
        if (!ready) return false;
        const pantin_clip &clip = character.animator.track.clip;
        for (uint8_t i = 0; i < 2; i++) {
            float units = static_cast<float>(character.animator.placement.place[i]);
            for (int8_t exponent = clip.exponent; exponent > 0; exponent--) units *= 2;
            for (int8_t exponent = clip.exponent; exponent < 0; exponent++) units /= 2;
            cm[i] = units * static_cast<float>(clip.rig.unit_micro_cm) / 1e6f;
        }
        return true;
    }

    /* How far it has turned about the vertical axis, -180 to 180 degrees. Returns false, and leaves `degrees`, before begin(). */
    bool heading(float &degrees) const {
        if (!ready) return false;
        degrees = static_cast<float>(pantin_centidegrees(character.animator.placement.heading)) / 100.0f;
        return true;
    }

    /* Puts it back to where it began. */
    void home() {
        pantin_placement nowhere = {{0, 0}, 0};
        if (ready) pantin_animator_stand(&character.animator, &nowhere);
    }

    /* Holds the pose until resume(). */
    void stop() { stopped = true; }
    void resume() { stopped = false; }

    /* Sets the speed in percent, 0 to 1000: 100 without a call. */
    void speed(uint16_t percentage) { percent = percentage > 1000 ? 1000 : percentage; }

    /* For PantinSolid: the player, NULL before begin(); and the pose of the last update, where the character stands. */
    pantin_player *playing() { return ready ? &character.animator.track.player : NULL; }
    void setPose(pantin_solid *solid) const {
        if (ready) pantin_solid_pose_at(solid, character.animator.pose, &character.animator.placement);
    }

    /* For all else that pantin_animator.h does. */
    pantin_character character;

  private:
    /* What a clip at play needs. */
    struct Playing {
        pantin_channel moving[ChannelCount];
        int32_t values[ChannelCount], pose[ChannelCount];
    };

    void lendLayers() {
        for (uint8_t i = 0; result == PANTIN_OK && i < character.counts[7]; i++) {
            if (i >= LayerCount) {
                result = PANTIN_NO_ROOM;
                return;
            }
            Playing &lent = layerMemory[i];
            result = pantin_character_layer(&character, &layers[i], lent.moving, ChannelCount, lent.values, lent.pose, ChannelCount, words[i], 16);
        }
    }

    PantinContent content;
    pantin_animator_memory memory;
    Playing own, second, layerMemory[LayerCount ? LayerCount : 1];
    pantin_offset offsets[ChannelCount];
    pantin_group groups[ChannelCount];
    pantin_track secondTrack;
    pantin_layer layers[LayerCount ? LayerCount : 1];
    uint32_t words[LayerCount ? LayerCount : 1][16];
    PantinHeldFeet<HoldsFeet> feet;
    uint32_t last;
    uint16_t percent = 100;
    pantin_result result = PANTIN_ERROR_HEAD;
    bool ready = false, running = false, stopped = false;
};

#endif
