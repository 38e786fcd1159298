#include "play/measure.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <thread>

#include "play/tour.h"

namespace cathlab::play {
namespace {

double resident_mb() {
    std::ifstream in("/proc/self/statm");
    double total = 0.0, resident = 0.0;
    in >> total >> resident;
    return resident * static_cast<double>(::sysconf(_SC_PAGESIZE)) / 1048576.0;
}

double quantile(std::vector<float> values, double share) {
    if (values.empty()) return 0.0;
    std::sort(values.begin(), values.end());
    return static_cast<double>(values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))]);
}

double since(Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

}  // namespace

void measure(PlayOptions options, const AppContext& context, double seconds) {
    const auto begin = Clock::now();
    options.at_once = true;
    options.task.clear();
    PlayApp app(options, context);
    while (app.screen() == Screen::loading && app.frame(1.0 / 60.0))
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    std::printf("window: %s\n", app.window().description().c_str());
    std::printf("from the start of the program's window to the first frame that can be steered: %.2f s\n",
                since(begin));
    const auto playing = Clock::now();
    send_key(SDL_SCANCODE_SPACE, true);
    std::uint64_t turns = 0;
    double next_mb = 0.0, next_key = 0.5;
    bool pushed = false, going = true;
    auto last = Clock::now();
    while (since(playing) < seconds && going) {
        const auto turn = Clock::now();
        going = app.frame(std::chrono::duration<double>(turn - last).count());
        last = turn;
        ++turns;
        const double now = since(playing);
        if (now >= next_key) {  // push and pull in turn, so that the wire stays where it is
            next_key += 0.7;
            send_key(pushed ? SDL_SCANCODE_W : SDL_SCANCODE_S, false);
            pushed = !pushed;
            send_key(pushed ? SDL_SCANCODE_W : SDL_SCANCODE_S, true);
        }
        if (now >= next_mb) {
            std::printf("after %5.0f s: %.0f MB, x%.2f of real time\n", now, resident_mb(),
                        app.simulation() != nullptr ? app.simulation()->status().real_time_factor : 0.0);
            std::fflush(stdout);
            next_mb += std::max(10.0, seconds / 10.0);
        }
        const double spent = since(turn);
        if (spent < 1.0 / 60.0) std::this_thread::sleep_for(std::chrono::duration<double>(1.0 / 60.0 - spent));
    }
    const double played = since(playing);
    const auto& latencies = app.latencies_ms();
    std::printf("hand to picture: median %.0f ms, 95 %% within %.0f ms, of %zu commands\n", quantile(latencies, 0.5),
                quantile(latencies, 0.95), latencies.size());
    if (app.simulation() != nullptr) {
        const Lateness late = app.simulation()->lateness();
        std::printf("steps began late by: median %.1f ms, p99 %.1f ms, of %llu steps of %.0f ms\n",
                    1e3 * late.quantile(0.5), 1e3 * late.quantile(0.99), static_cast<unsigned long long>(late.count()),
                    20.0);
    }
    if (app.painter() != nullptr)
        std::printf("pictures: fluoroscopy %.1f ms, inner view %.1f ms, from outside %.1f ms\n",
                    app.painter()->cost_ms(View::fluoroscopy), app.painter()->cost_ms(View::inner),
                    app.painter()->cost_ms(View::outer));
    std::printf("window: %.0f frames a second; memory %.0f MB\n", static_cast<double>(turns) / played, resident_mb());
}

}  // namespace cathlab::play
