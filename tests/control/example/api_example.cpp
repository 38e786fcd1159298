#include <cstdio>
#include <vector>

#include "control/simulator.h"

// Pushes the wire of a scene, and lets go of it while the force bar is over its limit; three trials of two seconds.
int main(int count, char** arguments) {
    using cathlab::Simulator;
    if (count < 3) return 2;
    Simulator simulator(arguments[1], arguments[2]);  // scenes/rigs/tube_wire.toml and the project's folder

    std::vector<double> action = simulator.idle();
    std::vector<double> seen(Simulator::observation_size());
    double& advance = action[Simulator::action("advance")];
    const double& bar = seen[Simulator::observation("force_bar")];
    const double& tip = seen[Simulator::observation("wire_tip_z_mm")];

    for (int trial = 0; trial < 3; ++trial) {
        simulator.reset(/*seed*/ 7);
        simulator.observe(seen);
        double largest = 0.0;
        for (int k = 0; k < 100; ++k) {
            advance = bar < 1.0 ? 40.0 : 0.0;  // mm/s
            simulator.step(action, seen);
            largest = bar > largest ? bar : largest;
            for (const cathlab::Event& event : simulator.events()) std::printf("  %s\n", event.message.c_str());
        }
        std::printf("tip at z = %.3f mm, force bar up to %.2f, state %016llx\n", tip, largest,
                    static_cast<unsigned long long>(simulator.state_hash()));
    }
}
