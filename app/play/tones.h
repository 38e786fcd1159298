// What is heard: X-rays, the alarm, the force.
#pragma once

#include <SDL_audio.h>

#include <span>
#include <string>
#include <vector>

#include "play/settings.h"

namespace cathlab::play {

struct ToneState {
    bool beam_on = false;
    double force_bar = 0.0;
};

/// Samples one after another without clicks: the phase goes on and the loudness glides.
class ToneMaker {
public:
    /// Mono, in [-1, 1], at `rate` samples a second.
    void make(const ToneState& state, const SoundSettings& settings, double rate, std::span<float> out);

private:
    double beam_phase_ = 0.0, alarm_phase_ = 0.0, force_phase_ = 0.0, beat_ = 0.0;
    double beam_level_ = 0.0, alarm_level_ = 0.0, force_level_ = 0.0;
};

/// Sends them to the loudspeaker.  Without one it is silent and says why.
class Tones {
public:
    Tones();
    ~Tones();
    Tones(const Tones&) = delete;
    Tones& operator=(const Tones&) = delete;
    /// Once a frame: keeps a short queue filled.
    void play(const ToneState& state, const SoundSettings& settings);
    const std::string& fault() const { return fault_; }

private:
    SDL_AudioDeviceID device_ = 0;
    bool started_ = false;
    double rate_ = 0.0;
    std::string fault_;
    ToneMaker maker_;
    std::vector<float> samples_;
};

}  // namespace cathlab::play
