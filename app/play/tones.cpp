#include "play/tones.h"

#include <SDL.h>

#include <algorithm>
#include <cmath>

#include "core/units.h"

namespace cathlab::play {
namespace {

constexpr double beam_hz = 330.0, alarm_hz = 880.0, force_low_hz = 180.0, force_high_hz = 700.0;
constexpr double alarm_share = 0.7, beats_per_s = 3.0;
constexpr double glide_s = 0.008;  // of the loudness
constexpr double queue_s = 0.07;
constexpr int wanted_rate = 48000;

double turned(double phase, double hz, double rate) {
    phase += hz / rate;
    return phase - std::floor(phase);
}

double wave(double phase) {
    return std::sin(2.0 * units::pi * phase);
}

}  // namespace

void ToneMaker::make(const ToneState& state, const SoundSettings& settings, double rate, std::span<float> out) {
    const double glide = std::min(1.0, 1.0 / (glide_s * rate));
    const double bar = std::clamp(state.force_bar, 0.0, 1.0);
    const bool alarm = state.force_bar >= alarm_share;
    const double on = settings.enabled ? settings.volume : 0.0;
    for (float& sample : out) {
        beat_ = turned(beat_, beats_per_s, rate);
        beam_phase_ = turned(beam_phase_, beam_hz, rate);
        alarm_phase_ = turned(alarm_phase_, alarm_hz, rate);
        force_phase_ = turned(force_phase_, force_low_hz + bar * (force_high_hz - force_low_hz), rate);
        const bool loud = state.force_bar >= 1.0 || beat_ < 0.5;
        beam_level_ += glide * ((state.beam_on ? 0.25 * on : 0.0) - beam_level_);
        alarm_level_ += glide * ((alarm && loud ? 0.5 * on : 0.0) - alarm_level_);
        force_level_ += glide * ((settings.force_tone && bar > 0.02 ? 0.25 * on : 0.0) - force_level_);
        sample = static_cast<float>(beam_level_ * wave(beam_phase_) + alarm_level_ * wave(alarm_phase_) +
                                    force_level_ * wave(force_phase_));
    }
}

Tones::Tones() {
    if (SDL_InitSubSystem(SDL_INIT_AUDIO) != 0) {
        fault_ = std::string("no sound: ") + SDL_GetError();
        return;
    }
    started_ = true;
    SDL_AudioSpec wanted{}, found{};
    wanted.freq = wanted_rate;
    wanted.format = AUDIO_F32SYS;
    wanted.channels = 1;
    wanted.samples = 1024;
    device_ = SDL_OpenAudioDevice(nullptr, 0, &wanted, &found, SDL_AUDIO_ALLOW_FREQUENCY_CHANGE);
    if (device_ == 0) {
        fault_ = std::string("no sound: ") + SDL_GetError();
        return;
    }
    rate_ = found.freq;
    SDL_PauseAudioDevice(device_, 0);
}

Tones::~Tones() {
    if (device_ != 0) SDL_CloseAudioDevice(device_);
    if (started_) SDL_QuitSubSystem(SDL_INIT_AUDIO);
}

void Tones::play(const ToneState& state, const SoundSettings& settings) {
    if (device_ == 0) return;
    const double queued = SDL_GetQueuedAudioSize(device_) / (sizeof(float) * rate_);
    if (queued >= queue_s) return;
    samples_.resize(static_cast<std::size_t>((queue_s - queued) * rate_));
    maker_.make(state, settings, rate_, samples_);
    SDL_QueueAudio(device_, samples_.data(), static_cast<Uint32>(samples_.size() * sizeof(float)));
}

}  // namespace cathlab::play
