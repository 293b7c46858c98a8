/* Lets each read of a paged source fail in turn, for every call that reads: it returns an error, and the same call again gives what it would have given.
 *
 *     reads BANK.ptb : a bank with a state machine, and perhaps with feet */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "failing.h"
#include "file.h"
#include "pantin_feet.h"

enum { CHANNELS = 160, PAGE = 128, UPDATES = 900, STEP_US = 33333, LAYERS = 4 };

/* A character with its memory, and a file with one read that fails. */
typedef struct {
    pantin_channel moving[CHANNELS], second_moving[CHANNELS], layer_moving[LAYERS][CHANNELS];
    int32_t values[CHANNELS], pose[CHANNELS], second_values[CHANNELS], layer_values[LAYERS][CHANNELS], sampled[LAYERS][CHANNELS];
    pantin_offset offsets[CHANNELS];
    pantin_group groups[CHANNELS];
    uint32_t words[LAYERS][8];
    uint8_t page[PAGE];
    pantin_pages pages;
    pantin_track second;
    pantin_layer layers[LAYERS];
    pantin_feet feet;
    pantin_animator_memory memory;
    pantin_character character;
} actor;

static actor now, kept, other;

static void check(int held, const char *what, uint32_t update, uint32_t k) {
    if (held) return;
    printf("failed: %s, update %u, read %u\n", what, (unsigned)update, (unsigned)k);
    exit(1);
}

static void prepare(size_t moving_room) {
    memset(&now, 0, sizeof now);
    now.memory.moving = now.moving;
    now.memory.values = now.values;
    now.memory.pose = now.pose;
    now.memory.offsets = now.offsets;
    now.memory.groups = now.groups;
    /* Less than the channels of the rig, where that is enough: the carrier is looked for in all clips. */
    now.memory.moving_room = moving_room;
    now.memory.channel_room = now.memory.group_room = CHANNELS;
    pantin_paged(&now.pages, length, read_bytes, NULL, now.page, PAGE);
}

static pantin_result open_now(void) { return pantin_character_open(&now.character, &now.pages.source, &now.memory, 0); }

static pantin_result lend_feet(void) { return pantin_character_feet(&now.character, &now.feet); }

static pantin_result lend_second(void) {
    return pantin_character_second(&now.character, &now.second, now.second_moving, CHANNELS, now.second_values, CHANNELS);
}

static pantin_result lend_layer(void) {
    uint8_t i = now.character.layer_count;
    return pantin_character_layer(&now.character, &now.layers[i], now.layer_moving[i], CHANNELS, now.layer_values[i], now.sampled[i], CHANNELS,
                                  now.words[i], 8);
}

static int same_place(const actor *a, const actor *b) {
    const pantin_animator *x = &a->character.animator, *y = &b->character.animator;
    return a->character.state == b->character.state && x->track.player.frame == y->track.player.frame &&
           x->track.rest == y->track.rest && memcmp(&x->placement.place, &y->placement.place, sizeof x->placement.place) == 0 &&
           x->placement.heading == y->placement.heading && x->event_count == y->event_count && x->left == y->left;
}

static int same_figure(const actor *a, const actor *b) { return memcmp(a->pose, b->pose, sizeof a->pose) == 0 && same_place(a, b); }

/* A call that prepares a character: a failed read is an error, after which the call gives what it gives without it. */
static void prepares(pantin_result (*call)(void), const char *what) {
    uint32_t k, count;
    kept = now;
    let_fail(0, 0);
    check(call() == PANTIN_OK, what, 0, 0);
    other = now;
    count = reads;
    check(count > 3, "the call reads", 0, 0);
    for (k = 1; k <= count; k++) {
        now = kept;
        let_fail(k, k);
        check(call() == PANTIN_ERROR_READ, what, 0, k);
        let_fail(0, 0);
        check(call() == PANTIN_OK && same_figure(&now, &other), "the call again", 0, k);
        check(memcmp(now.groups, other.groups, sizeof now.groups) == 0 && memcmp(now.words, other.words, sizeof now.words) == 0, "what it found", 0, k);
    }
    printf("%s: %u reads\n", what, (unsigned)count);
}

/* What is pressed before an update: as in a session of all of the table's inputs. */
static void press(uint32_t update) {
    pantin_character *c = &now.character;
    uint8_t input;
    for (input = 0; input < c->counts[4]; input++) {
        pantin_character_hold(c, input, (update / 37 + input) % 3 == 0);
        if (update % 23 == 5u * input % 23) pantin_character_fire(c, input);
    }
}

static pantin_result update_now(void) { return pantin_character_update(&now.character, STEP_US); }

/* An update of which reads fail. Returns 1 if it then does what it would have done. */
static int update_again(uint32_t update, uint32_t from, uint32_t to, int early) {
    pantin_result result;
    uint8_t ended, again = 0;
    now = kept;
    let_fail(from, to);
    check(update_now() == PANTIN_ERROR_READ, "an update without a read", update, from);
    check(now.character.state == kept.character.state && now.character.fired == kept.character.fired && now.character.held == kept.character.held &&
              now.character.seen == kept.character.seen,
          "state and inputs stay", update, from);
    check(now.character.animator.track.player.frame == kept.character.animator.track.player.frame &&
              now.character.animator.track.rest == kept.character.animator.track.rest,
          "time stays", update, from);
    ended = now.character.animator.left != kept.character.animator.left;
    if (!ended && !now.character.animator.track.stale && !early) {
        /* Where a state is entered, feet end what was rounded for a whole transition: the pose that is composed again differs in last bits. */
        uint8_t rounded = kept.character.feet && kept.character.entered;
        check(rounded ? same_place(&now, &kept) : same_figure(&now, &kept), "the figure stays", update, from);
    }
    let_fail(0, 0);
    while ((result = update_now()) != PANTIN_OK && again++ < 2) {}
    check(result == PANTIN_OK, "the update again", update, from);
    /* A transition that waits for another one begins sooner once that has ended. */
    check(ended || now.character.state == other.character.state, "the state afterwards", update, from);
    if (!ended) check(same_figure(&now, &other), "the figure afterwards", update, from);
    return !ended;
}

static void updates(void) {
    uint32_t update, k, count, failed = 0, whole = 0, states = 0, blends = 0, over = 0, held = 0, waits = 0;
    for (update = 0; update < UPDATES; update++) {
        press(update);
        kept = now;
        let_fail(0, 0);
        check(update_now() == PANTIN_OK, "an update", update, 0);
        count = reads;
        states += now.character.entered;
        blends += now.character.blending;
        over += now.character.layer_count && now.character.layers[0]->doing;
        held += pantin_character_held(&now.character, 0) != PANTIN_NO_JOINT;
        waits += now.character.waiting != 255;
        other = now;
        for (k = 1; k <= count; k++) {
            whole += (uint32_t)update_again(update, k, k, 0);
            failed++;
            if (k % 7 == 0) {
                whole += (uint32_t)update_again(update, k, k + 1 + k % 40, 1);
                failed++;
            }
        }
        now = other;
    }
    printf("updates: %u failures, %u of them end no transition; %u states entered, %u updates blend, in %u a layer plays, in %u a foot is held, in %u a "
           "transition waits\n",
           (unsigned)failed, (unsigned)whole, (unsigned)states, (unsigned)blends, (unsigned)over, (unsigned)held, (unsigned)waits);
    check(!now.character.feet || (held > 50 && waits > 5), "feet were not tried", 0, 0);
    check(states > 10 && whole > failed / 2 && (over > 10 || !now.character.layer_count), "little was tried", 0, 0);
}

static void names(void) {
    pantin_joint joint;
    pantin_scalar scalar;
    pantin_joint_ref ref;
    pantin_clip clip;
    pantin_entry entry;
    uint32_t id;
    const pantin_character *c = &now.character;
    let_fail(0, 0);
    check(pantin_character_input(c, NULL) == PANTIN_NO_INPUT && pantin_character_state(c, NULL) == PANTIN_NO_INPUT &&
              pantin_character_parameter(c, NULL) == PANTIN_NO_INPUT,
          "no input has no name", 0, 0);
    check(pantin_open_named(&clip, &c->bank, NULL) == PANTIN_NOT_FOUND, "no clip has no name", 0, 0);
    check(!pantin_find_joint(&c->bank.rig, NULL, &joint) && !pantin_find_scalar(&c->bank.rig, NULL, &scalar), "no joint has no name", 0, 0);
    check(pantin_find(&c->animator.track.clip, NULL, &ref) == PANTIN_NOT_FOUND, "nothing is found", 0, 0);
    check(pantin_find_event(&c->animator.track.clip, NULL, &id) == PANTIN_NOT_FOUND, "no event has no name", 0, 0);
    pantin_first_entry(&entry, &c->bank);
    check(pantin_next_entry(&entry) && !pantin_name_is(&entry.name, NULL), "a name is not none", 0, 0);
}

int main(int argc, char **argv) {
    uint8_t *content, i;
    if (argc < 2) return 2;
    content = file(argv[1], &length);
    bytes = content;
    prepare(30);
    if (open_now() == PANTIN_NO_ROOM) {
        prepare(CHANNELS);
    } else {
        prepare(30);
    }
    prepares(open_now, "open");
    prepares(lend_second, "second");
    for (i = 0; now.character.layer_count < now.character.counts[7] && i < LAYERS; i++) prepares(lend_layer, "layer");
    if (now.character.needs_feet) prepares(lend_feet, "feet");
    names();
    updates();
    free(content);
    return 0;
}
