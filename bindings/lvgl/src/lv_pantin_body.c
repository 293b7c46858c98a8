/* The body of lv_pantin: see lv_pantin_body.h. */
#include "lv_pantin_body.h"

#if LV_PANTIN_BODY

/* Duration of the transition that lv_pantin_play makes, in frames. */
#define TRANSITION 8

/* Memory that is dealt out; without a start it is only counted. */
typedef struct {
    uint8_t *start;
    size_t used;
} room_t;

static void *take(room_t *room, size_t count, size_t size) {
    void *taken = room->start ? room->start + room->used : NULL;
    room->used += (count * size + 7) / 8 * 8;
    return taken;
}

/* How many moving channels a clip needs. */
static uint16_t moving_of(const pantin_clip *clip, int32_t *pose) {
    pantin_player player;
    pantin_channel none;
    pantin_result result = pantin_start(&player, clip, pose, clip->rig.channels, &none, 0);
    return result == PANTIN_OK || result == PANTIN_NO_ROOM ? player.moving_count : 0;
}

/* How many the clip of a bank needs that needs most. Damaged clips are passed over: they are refused when they are to be played. */
static uint16_t most_moving(const pantin_bank *bank, int32_t *pose) {
    pantin_entry entry;
    pantin_clip clip;
    uint16_t most = 0, moving;
    pantin_first_entry(&entry, bank);
    while (pantin_next_entry(&entry)) {
        if (pantin_open_entry(&clip, &entry) != PANTIN_OK) continue;
        moving = moving_of(&clip, pose);
        most = LV_MAX(most, moving);
    }
    return most;
}

/* Deals out the memory of a body without second clips, layers and feet. Returns its size. */
static size_t lay_out(uint8_t *memory, uint16_t channels, uint16_t moving, uint16_t joints) {
    room_t room = {memory, 0};
    size_t bones = (size_t)joints + 1;
    pantin_animator_memory lent;
    pantin_bone *bone;
    pantin_drive *drives;
    pantin_slot *slots;
    lv_pantin_body_t *body = (lv_pantin_body_t *)take(&room, 1, sizeof *body);
    lent.moving = (pantin_channel *)take(&room, moving, sizeof *lent.moving);
    lent.moving_room = moving;
    lent.values = (int32_t *)take(&room, channels, sizeof *lent.values);
    lent.pose = (int32_t *)take(&room, channels, sizeof *lent.pose);
    lent.offsets = (pantin_offset *)take(&room, channels, sizeof *lent.offsets);
    /* Each group has a channel. */
    lent.groups = (pantin_group *)take(&room, channels, sizeof *lent.groups);
    lent.channel_room = lent.group_room = channels;
    bone = (pantin_bone *)take(&room, bones, sizeof *bone);
    drives = (pantin_drive *)take(&room, channels, sizeof *drives);
    slots = (pantin_slot *)take(&room, PANTIN_FIGURE_SLOTS, sizeof *slots);
    if (body) {
        lv_memzero(body, sizeof *body);
        body->memory = lent;
        pantin_figure_memory(&body->solid.figure, bone, bones, drives, channels, slots, PANTIN_FIGURE_SLOTS);
    }
    return room.used;
}

/* Lends what the table of a machine that was opened asks for: a second clip, layers, feet. In the first pass the memory is counted. */
static pantin_result lend_parts(lv_pantin_body_t *body) {
    pantin_character *c = &body->character;
    size_t channels = c->bank.rig.channels, words = ((size_t)c->bank.rig.joints + c->bank.rig.scalars + 31) / 32, moving = body->memory.moving_room;
    uint8_t pass, i;
    for (pass = 0; pass < 2; pass++) {
        room_t room = {body->parts, 0};
        pantin_track *second = (pantin_track *)take(&room, 1, sizeof *second);
        pantin_channel *its_moving = (pantin_channel *)take(&room, moving, sizeof *its_moving);
        int32_t *values = (int32_t *)take(&room, channels, sizeof *values);
        pantin_feet *feet = (pantin_feet *)take(&room, c->needs_feet, sizeof *feet);
        pantin_result result = pass ? pantin_character_second(c, second, its_moving, moving, values, channels) : PANTIN_OK;
        if (result == PANTIN_OK && pass && c->needs_feet) result = pantin_character_feet(c, feet);
        for (i = 0; i < c->counts[7] && result == PANTIN_OK; i++) {
            pantin_layer *layer = (pantin_layer *)take(&room, 1, sizeof *layer);
            int32_t *sampled = (int32_t *)take(&room, channels, sizeof *sampled);
            uint32_t *bits = (uint32_t *)take(&room, words, sizeof *bits);
            its_moving = (pantin_channel *)take(&room, moving, sizeof *its_moving);
            values = (int32_t *)take(&room, channels, sizeof *values);
            if (pass) result = pantin_character_layer(c, layer, its_moving, moving, values, sampled, channels, bits, words);
        }
        if (result != PANTIN_OK) return result;
        if (!pass) body->parts = (uint8_t *)lv_malloc(room.used);
        if (!body->parts) return PANTIN_NO_ROOM;
    }
    return PANTIN_OK;
}

/* Opens what the bytes are: a clip, or a bank, whose first clip is `first`. */
static pantin_result open_first(const uint8_t *bytes, uint32_t length, pantin_source *source, pantin_bank *bank, pantin_clip *first) {
    pantin_entry entry;
    pantin_memory(source, bytes, length);
    if (pantin_open_bank(bank, source) != PANTIN_OK) {
        bank->source = NULL;
        return pantin_open(first, source, NULL);
    }
    pantin_first_entry(&entry, bank);
    return pantin_next_entry(&entry) ? pantin_open_entry(first, &entry) : PANTIN_ERROR_BANK;
}

/* Opens the state machine of a bank, or an animator for the first clip where there is none. */
static pantin_result open_player(lv_pantin_body_t *body) {
    pantin_character *c = &body->character;
    pantin_result result = body->bank.source ? pantin_character_open(c, &body->source, &body->memory, 0) : PANTIN_NOT_FOUND;
    if (result == PANTIN_NOT_FOUND) return pantin_animator_open(&c->animator, &body->clip, &body->memory);
    if (result == PANTIN_OK) result = lend_parts(body);
    body->machine = 1;
    body->clip = c->animator.track.clip;
    return result;
}

lv_pantin_body_t *lv_pantin_body_open(const uint8_t *bytes, uint32_t length) {
    pantin_source source;
    pantin_bank bank;
    pantin_clip first;
    uint16_t moving, channels;
    int32_t *pose;
    lv_pantin_body_t *body;
    if (open_first(bytes, length, &source, &bank, &first) != PANTIN_OK || !first.rig.joints || !first.rig.channels) return NULL;
    channels = first.rig.channels;
    pose = (int32_t *)lv_malloc(channels * sizeof *pose);
    if (!pose) return NULL;
    moving = bank.source ? most_moving(&bank, pose) : moving_of(&first, pose);
    lv_free(pose);
    body = (lv_pantin_body_t *)lv_malloc(lay_out(NULL, channels, moving, first.rig.joints));
    if (!body) return NULL;
    lay_out((uint8_t *)body, channels, moving, first.rig.joints);
    if (open_first(bytes, length, &body->source, &body->bank, &body->clip) == PANTIN_OK && open_player(body) == PANTIN_OK) return body;
    lv_pantin_body_close(body);
    return NULL;
}

void lv_pantin_body_close(lv_pantin_body_t *body) {
    if (body) lv_free(body->parts);
    lv_free(body);
}

/* ---- The figure ---- */

pantin_result lv_pantin_body_size(lv_pantin_body_t *body, const lv_pantin_settings *settings, uint16_t width, uint16_t height) {
    pantin_clip *clip = &body->clip;
    size_t channels = clip->rig.channels, moving = body->memory.moving_room;
    room_t room = {NULL, 0};
    pantin_player player;
    pantin_result result;
    uint8_t pass;
    int32_t *pose = NULL;
    pantin_channel *states = NULL;
    pantin_joint_info *scratch = NULL;
    uint8_t *memory = NULL;
    /* The camera looks at the clip through a player of its own, so that what plays goes on as it is. */
    for (pass = 0; pass < 2; pass++) {
        room.start = memory;
        room.used = 0;
        pose = (int32_t *)take(&room, channels, sizeof *pose);
        states = (pantin_channel *)take(&room, moving, sizeof *states);
        scratch = (pantin_joint_info *)take(&room, clip->rig.joints, sizeof *scratch);
        if (!memory) memory = (uint8_t *)lv_malloc(room.used);
        if (!memory) return PANTIN_NO_ROOM;
    }
    result = pantin_start(&player, clip, pose, channels, states, moving);
    if (result == PANTIN_OK) result = pantin_solid_look(&body->solid, settings->look, settings->look_length);
    if (result == PANTIN_OK) result = pantin_solid_set_up(&body->solid, &player, width, height, scratch, clip->rig.joints);
    if (result == PANTIN_OK) result = pantin_solid_aim(&body->solid, &player, &settings->view);
    lv_free(memory);
    return result;
}

bool lv_pantin_body_has_size(const lv_pantin_body_t *body, uint16_t width, uint16_t height) {
    return body->solid.figure.width == width && body->solid.figure.height == height;
}

pantin_result lv_pantin_body_play(lv_pantin_body_t *body, const lv_pantin_settings *settings, const char *name) {
    pantin_animator *animator = &body->character.animator;
    const pantin_figure *figure = &body->solid.figure;
    pantin_clip clip = animator->track.clip;
    pantin_result result = PANTIN_OK;
    if (body->machine) return PANTIN_UNSUPPORTED;
    if (name) result = body->bank.source ? pantin_open_named(&clip, &body->bank, name) : PANTIN_NOT_FOUND;
    if (result == PANTIN_OK) result = pantin_animator_switch(animator, &clip, 0, PANTIN_SPEED, PANTIN_INERTIALIZED, TRANSITION);
    if (result != PANTIN_OK) return result;
    body->ended = 0;
    if (clip.exponent == body->clip.exponent && clip.coding == body->clip.coding) return PANTIN_OK;
    /* The figure reads poses in the form of the clip for which it is set up. */
    body->clip = clip;
    return figure->width ? lv_pantin_body_size(body, settings, figure->width, figure->height) : PANTIN_OK;
}

pantin_result lv_pantin_body_step(lv_pantin_body_t *body, uint16_t ms) {
    pantin_character *c = &body->character;
    uint8_t ended = c->animator.track.ended;
    pantin_result result =
        body->machine ? pantin_character_update(c, ms * (uint32_t)1000) : pantin_animator_update(&c->animator, ms * (uint32_t)1000);
    body->entered = result == PANTIN_OK && body->machine && c->entered;
    body->ended = result == PANTIN_OK && !ended && c->animator.track.ended;
    return result;
}

void lv_pantin_body_pose(lv_pantin_body_t *body, const lv_pantin_settings *settings) {
    pantin_animator *animator = &body->character.animator;
    if (settings->lines) {
        pantin_figure_pose_at(&body->solid.figure, animator->pose, &animator->placement);
    } else {
        pantin_solid_pose_at(&body->solid, animator->pose, &animator->placement);
    }
}

pantin_result lv_pantin_body_draw(const lv_pantin_body_t *body, const lv_pantin_settings *settings, pantin_format format, void *rows, uint32_t stride,
                                  uint16_t y0, uint16_t y1) {
    return settings->lines ? pantin_figure_draw(&body->solid.figure, format, rows, stride, y0, y1, settings->floor)
                           : pantin_solid_draw(&body->solid, format, rows, stride, y0, y1, settings->floor);
}

#endif
