/* The texts of statuses that the tests set. */
#pragma once

namespace Lang::Strings {
constexpr const char* STANDBY = "Standby";
constexpr const char* CONNECTING = "Connecting...";
constexpr const char* LISTENING = "Listening...";
constexpr const char* SPEAKING = "Speaking...";
}  // namespace Lang::Strings
