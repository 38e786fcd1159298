#include "play/pads.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace cathlab::play {
namespace {

constexpr Uint32 rumble_ms = 250, refresh_ms = 100;
constexpr double alarm_share = 0.7;  // of the force bar, as the panels draw it
constexpr double pulses_per_s = 3.0;
constexpr double felt = 0.02;  // of the force bar: less is rest

Uint16 motor(double strength) {
    return static_cast<Uint16>(std::lround(65535.0 * std::clamp(strength, 0.0, 1.0)));
}

}  // namespace

Tremble tremble_of(double force_bar, double strength, double time_s) {
    if (!(force_bar > felt) || strength <= 0.0) return {};
    const double share = std::min(1.0, force_bar);
    Tremble out{0.15 + 0.45 * share, 0.0};
    if (force_bar >= alarm_share) {
        const bool beat = std::fmod(time_s * pulses_per_s, 1.0) < 0.5;
        out.high = beat ? (force_bar >= 1.0 ? 1.0 : 0.6) : 0.0;
        if (force_bar >= 1.0) out.low = 1.0;
    }
    return {strength * out.low, strength * out.high};
}

Pads::Pads(const std::string& data_folder) {
    SDL_SetHint(SDL_HINT_JOYSTICK_ALLOW_BACKGROUND_EVENTS, "1");
    if (SDL_InitSubSystem(SDL_INIT_GAMECONTROLLER) != 0) {
        fault_ = std::string("no game controllers: ") + SDL_GetError() + "; keyboard and mouse do everything";
        return;
    }
    const std::string mappings = data_folder + "/gamecontrollerdb.txt";
    std::error_code error;
    if (std::filesystem::is_regular_file(mappings, error)) SDL_GameControllerAddMappingsFromFile(mappings.c_str());
}

Pads::~Pads() {
    for (const auto& [id, pad] : open_) SDL_GameControllerClose(pad);
    if (fault_.empty()) SDL_QuitSubSystem(SDL_INIT_GAMECONTROLLER);
}

std::string Pads::feed(const SDL_Event& event) {
    if (event.type == SDL_CONTROLLERDEVICEADDED) {
        SDL_GameController* pad = SDL_GameControllerOpen(event.cdevice.which);
        if (pad == nullptr) return std::string("a game controller cannot be used: ") + SDL_GetError();
        const SDL_JoystickID id = SDL_JoystickInstanceID(SDL_GameControllerGetJoystick(pad));
        if (!open_.emplace(id, pad).second) {
            SDL_GameControllerClose(pad);
            return "";
        }
        const char* name = SDL_GameControllerName(pad);
        return std::string("controller: ") + (name == nullptr ? "plugged in" : name);
    }
    if (event.type == SDL_CONTROLLERDEVICEREMOVED) {
        const auto it = open_.find(event.cdevice.which);
        if (it == open_.end()) return "";
        SDL_GameControllerClose(it->second);
        open_.erase(it);
        return "The controller was unplugged: the devices stand still";
    }
    return "";
}

void Pads::rumble(double low, double high) {
    const Uint64 now = SDL_GetTicks64();
    const bool same = std::fabs(low - low_) < 0.02 && std::fabs(high - high_) < 0.02;
    if (same && (now - sent_at_ms_ < refresh_ms || (low <= 0.0 && high <= 0.0))) return;
    low_ = low;
    high_ = high;
    sent_at_ms_ = now;
    for (const auto& [id, pad] : open_) SDL_GameControllerRumble(pad, motor(low), motor(high), rumble_ms);
}

}  // namespace cathlab::play
