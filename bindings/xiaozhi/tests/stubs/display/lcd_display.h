/* The display classes of the firmware, as far as PantinDisplay and its tests need them: objects that stand one above the other on the screen, and a lock
 * that can fail. */
#pragma once

#include <string>

#include "lvgl.h"

typedef void* esp_lcd_panel_io_handle_t;
typedef void* esp_lcd_panel_handle_t;

class Display {
public:
    virtual ~Display() {}
    virtual void SetupUI() {}
    virtual void SetEmotion(const char*) {}
    virtual void SetStatus(const char*) {}
    virtual void SetChatMessage(const char*, const char*) {}
    virtual void ShowNotification(const char*, int = 3000) {}
    virtual void ShowNotification(const std::string& notification, int duration_ms = 3000) {
        ShowNotification(notification.c_str(), duration_ms);
    }

protected:
    int width_ = 0;
    int height_ = 0;
    virtual bool Lock(int timeout_ms = 0) = 0;
    virtual void Unlock() = 0;
};

class LcdDisplay : public Display {
public:
    inline static bool lock_fails = false;
    inline static int locked = 0; /* calls of Lock that succeeded less calls of Unlock */

    ~LcdDisplay() override {
        for (lv_obj_t* object : {container_, emoji_box_, status_label_, chat_message_label_}) {
            if (object != nullptr) lv_obj_delete(object);
        }
    }
    void SetupUI() override {
        container_ = lv_obj_create(lv_screen_active());
        lv_obj_set_size(container_, width_, height_);
        emoji_box_ = lv_obj_create(lv_screen_active());
        lv_obj_center(emoji_box_);
        status_label_ = lv_label_create(lv_screen_active());
        chat_message_label_ = lv_label_create(lv_screen_active());
        lv_obj_align(chat_message_label_, LV_ALIGN_BOTTOM_MID, 0, 0);
    }
    void SetStatus(const char* status) override { Show(status_label_, status); }
    void SetChatMessage(const char*, const char* content) override { Show(chat_message_label_, content); }
    using Display::ShowNotification;
    void ShowNotification(const char* notification, int = 3000) override { Show(status_label_, notification); }

    lv_obj_t* status_label() const { return status_label_; }
    lv_obj_t* emoji_box() const { return emoji_box_; }

protected:
    LcdDisplay(int width, int height) {
        width_ = width;
        height_ = height;
    }
    bool Lock(int = 0) override {
        locked += !lock_fails;
        return !lock_fails;
    }
    void Unlock() override { locked--; }

    lv_obj_t* container_ = nullptr;
    lv_obj_t* emoji_box_ = nullptr;
    lv_obj_t* status_label_ = nullptr;
    lv_obj_t* chat_message_label_ = nullptr;

private:
    void Show(lv_obj_t* label, const char* text) {
        if (label != nullptr && Lock(0)) {
            lv_label_set_text(label, text);
            Unlock();
        }
    }
};

class SpiLcdDisplay : public LcdDisplay {
public:
    SpiLcdDisplay(esp_lcd_panel_io_handle_t, esp_lcd_panel_handle_t, int width, int height, int, int, bool, bool, bool) : LcdDisplay(width, height) {}
};
