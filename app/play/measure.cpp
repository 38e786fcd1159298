#include "play/measure.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <ctime>
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

double since(Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

// A hand that pushes and pulls in turn, so that the wire stays where it is; on a thread of its own, so that it moves at
// any time of a turn.
class Hand {
public:
    Hand() : thread_([this] { loop(); }) {}
    ~Hand() {
        ends_ = true;
        thread_.join();
    }
    Hand(const Hand&) = delete;
    Hand& operator=(const Hand&) = delete;

private:
    void loop() {
        bool push = false;
        for (int i = 0; !ends_; ++i) {
            std::this_thread::sleep_for(std::chrono::milliseconds(320 + 37 * (i % 7)));
            send_key(push ? SDL_SCANCODE_W : SDL_SCANCODE_S, false);
            push = !push;
            send_key(push ? SDL_SCANCODE_W : SDL_SCANCODE_S, true);
        }
    }
    std::atomic<bool> ends_ = false;
    std::thread thread_;
};

void print(const char* what, const Durations& times) {
    if (times.count() == 0) return;
    std::printf("%s: median %.1f ms, 95 %% within %.1f ms, p99 %.1f ms, of %llu\n", what, 1e3 * times.quantile(0.5),
                1e3 * times.quantile(0.95), 1e3 * times.quantile(0.99), static_cast<unsigned long long>(times.count()));
}

}  // namespace

void measure(PlayOptions options, const AppContext& context, double seconds) {
    const auto begin = Clock::now();
    options.at_once = true;
    options.task.clear();
    PlayApp app(options, context);
    while (app.screen() == Screen::loading && app.frame(1.0 / 60.0))
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    std::printf("window: %s, %d x %d\n", app.window().description().c_str(), app.window().width(),
                app.window().height());
    std::printf("from the start of the program's window to the first frame that can be steered: %.2f s\n",
                since(begin));
    send_key(SDL_SCANCODE_SPACE, true);
    const Hand hand;
    const auto playing = Clock::now();
    const std::clock_t processor = std::clock();
    std::uint64_t turns = 0;
    double next_mb = 0.0;
    for (const Side side : {Side::displacement, Side::inner}) {
        app.set_side(side);
        app.forget_latencies();
        const double end = side == Side::inner ? seconds : 0.5 * seconds;
        for (double now = since(playing); now < end && app.turn(); now = since(playing), ++turns) {
            if (now < next_mb) continue;
            std::printf("after %5.0f s: %.1f MB, x%.2f of real time\n", now, resident_mb(),
                        app.simulation() != nullptr ? app.simulation()->status().real_time_factor : 0.0);
            std::fflush(stdout);
            next_mb += std::max(10.0, seconds / 10.0);
        }
        print(side == Side::inner ? "hand to window, inner view" : "hand to window, from outside", app.latencies());
    }
    const double played = since(playing);
    if (app.simulation() != nullptr) {
        const SimThread::Pace pace = app.simulation()->pace();
        print("a step with its description", pace.cost);
        print("steps began late by", pace.late);
    }
    if (app.painter() != nullptr) {
        print("a fluoroscopy", app.painter()->cost(View::fluoroscopy));
        print("an inner view", app.painter()->cost(View::inner));
        print("a view from outside", app.painter()->cost(View::outer));
    }
    print("a turn of the window", app.turn_cost());
    std::printf("window: %.0f frames a second; %.2f processors busy; memory %.1f MB\n",
                static_cast<double>(turns) / played,
                static_cast<double>(std::clock() - processor) / CLOCKS_PER_SEC / played, resident_mb());
}

}  // namespace cathlab::play
