// The game controllers that are plugged in, now and later, and their trembling.
#pragma once

#include <SDL.h>

#include <map>
#include <string>

namespace cathlab::play {

class Pads {
public:
    /// Starts SDL's controllers and takes mappings from DATA/gamecontrollerdb.txt where there is one.
    explicit Pads(const std::string& data_folder);
    ~Pads();
    Pads(const Pads&) = delete;
    Pads& operator=(const Pads&) = delete;

    /// Opens what is plugged in and lets go what is pulled out; a sentence for the trainee, or "".
    std::string feed(const SDL_Event& event);
    bool any() const { return !open_.empty(); }
    /// "" or why there are no controllers.
    const std::string& fault() const { return fault_; }
    /// Strengths from 0 to 1, for about a quarter of a second; call again before that is over.
    void rumble(double low, double high);

private:
    std::map<SDL_JoystickID, SDL_GameController*> open_;
    std::string fault_;
    double low_ = 0.0, high_ = 0.0;
    Uint64 sent_at_ms_ = 0;
};

/// What the pad does at a force: it trembles in proportion, pulses from the alarm mark on, and strongly at the limit.
struct Tremble {
    double low = 0.0, high = 0.0;  ///< of the two motors, 0 to 1
};
Tremble tremble_of(double force_bar, double strength, double time_s);

}  // namespace cathlab::play
