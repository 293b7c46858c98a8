#include "pantin_display.h"

#include <algorithm>
#include <cstring>

#include <esp_log.h>

#include "assets/lang_config.h"

#define TAG "PantinDisplay"

namespace {

constexpr uint32_t kTimerMs = 20;    // shorter than LV_PANTIN_PERIOD: each picture has new sound
constexpr int kLockMs = 30000;       // as long as the firmware waits elsewhere
constexpr uint32_t kMostMs = 1000;   // after a pause of LVGL's task, sound of at most this time is due
constexpr uint32_t kSamples = PANTIN_DISPLAY_SAMPLES;
static_assert((kSamples & (kSamples - 1)) == 0, "PANTIN_DISPLAY_SAMPLES is a power of two");

}  // namespace

PantinDisplay::~PantinDisplay() {
    if (face_ == nullptr) {
        return;
    }
    bool locked = Lock(kLockMs);
    lv_timer_delete(timer_);
    lv_obj_delete(face_);
    if (locked) {
        Unlock();
    }
}

void PantinDisplay::SetupUI() {
    PANTIN_DISPLAY_BASE::SetupUI();
    if (face_ != nullptr) {
        return;
    }
    if (!Lock(kLockMs)) {
        ESP_LOGE(TAG, "no face: LVGL's lock is not available");
        return;
    }
    lv_obj_t* face = lv_pantin_create(lv_screen_active());
    timer_ = face != nullptr ? lv_timer_create(OnTimer, kTimerMs, this) : nullptr;
    if (timer_ != nullptr) {
        lv_obj_set_size(face, width_, height_);
        // The face covers the emoji. The base class shows and hides it at the camera's previews, so that hiding it here would not last.
        if (emoji_box_ != nullptr) {
            lv_obj_move_to_index(face, lv_obj_get_index(emoji_box_) + 1);
        }
        last_tick_ = lv_tick_get();
        face_ = face;
    } else {
        ESP_LOGE(TAG, "no face: LVGL has no memory for it");
        if (face != nullptr) {
            lv_obj_delete(face);
        }
    }
    Unlock();
}

void PantinDisplay::SetEmotion(const char* emotion) {
    if (face_ == nullptr) {
        ESP_LOGW(TAG, "there is no face for the emotion %s", emotion != nullptr ? emotion : "NULL");
        return;
    }
    // The widget keeps the list of emotes as it is, so that this needs no lock.
    const pantin_face* face = lv_pantin_get_face(face_);
    const pantin_emote* end = face->emotes + face->emote_count;
    const pantin_emote* found =
        std::find_if(face->emotes, end, [=](const pantin_emote& emote) { return emotion != nullptr && strcmp(emote.name, emotion) == 0; });
    if (found == end) {
        ESP_LOGW(TAG, "there is no emotion %s: neutral is shown", emotion != nullptr ? emotion : "NULL");
    }
    emotion_ = found != end ? found->name : "neutral";
}

void PantinDisplay::SetStatus(const char* status) {
    listening_ = status != nullptr && strcmp(status, Lang::Strings::LISTENING) == 0;
    PANTIN_DISPLAY_BASE::SetStatus(status);
}

void PantinDisplay::PlayedPcm(const int16_t* samples, size_t count, int sample_rate) {
    rate_ = sample_rate;
    uint32_t written = written_.load(std::memory_order_relaxed);
    uint32_t room = kSamples - (written - read_.load(std::memory_order_acquire));
    uint32_t taken = static_cast<uint32_t>(std::min<size_t>(count, room));
    uint32_t start = written % kSamples;
    uint32_t first = std::min(taken, kSamples - start);
    std::copy_n(samples, first, samples_ + start);
    std::copy_n(samples + first, taken - first, samples_);
    written_.store(written + taken, std::memory_order_release);
}

// LVGL's task calls this with LVGL's lock held.
void PantinDisplay::OnTimer(lv_timer_t* timer) {
    auto* display = static_cast<PantinDisplay*>(lv_timer_get_user_data(timer));
    display->ShowEmote();
    display->MoveLips();
}

void PantinDisplay::ShowEmote() {
    const char* emote = listening_ ? "listening" : emotion_.load();
    if (emote != shown_) {
        shown_ = emote;
        lv_pantin_set_emote(face_, emote);
    }
}

// Passes the samples to the widget that were played since the last call.
void PantinDisplay::MoveLips() {
    uint32_t elapsed_ms = lv_tick_elaps(last_tick_);
    last_tick_ += elapsed_ms;
    uint32_t waiting = written_.load(std::memory_order_acquire) - read_;
    int rate = rate_;
    if (rate != known_rate_) {
        known_rate_ = rate;
        uint32_t hz = static_cast<uint32_t>(std::max(rate, 0));
        lips_rate_ = lv_pantin_set_rate(face_, hz) == LV_RESULT_OK ? hz : 0;
        if (lips_rate_ == 0) {
            ESP_LOGW(TAG, "the lips do not move: sound has 8,000 to 48,000 Hz, not %d", rate);
        }
    }
    if (lips_rate_ == 0 || waiting == 0) {
        read_.store(read_ + waiting, std::memory_order_release);
        milli_samples_ = 0;
        return;
    }
    milli_samples_ += std::min(elapsed_ms, kMostMs) * lips_rate_;
    uint32_t due = std::min(waiting, milli_samples_ / 1000);
    milli_samples_ %= 1000;
    uint32_t start = read_ % kSamples;
    uint32_t first = std::min(due, kSamples - start);
    lv_pantin_push_pcm(face_, samples_ + start, first);
    lv_pantin_push_pcm(face_, samples_, due - first);
    read_.store(read_ + due, std::memory_order_release);
}
