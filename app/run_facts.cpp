#include "run_facts.h"

#include <sys/utsname.h>
#include <unistd.h>

#include <chrono>
#include <ctime>
#include <nlohmann/json.hpp>

namespace cathlab {
namespace {

std::string host_text() {
    utsname names{};
    if (::uname(&names) != 0) return "unknown";
    return std::string(names.nodename) + " " + names.machine + ", " + std::to_string(::sysconf(_SC_NPROCESSORS_ONLN)) +
           " processors";
}

}  // namespace

std::string utc_now() {
    const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
    std::tm parts{};
    ::gmtime_r(&now, &parts);
    char text[32];
    std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
    return text;
}

std::string metrics_json(const Metrics& metrics) {
    nlohmann::ordered_json out;
    for (const MetricInfo& metric : metric_table()) out[std::string(metric.name)] = metrics.*metric.value;
    return out.dump(2) + "\n";
}

RunManifest manifest_of(const SceneSpec& scene, const std::vector<std::string>& overlays, std::uint64_t anatomy_hash,
                        const AppContext& context) {
    RunManifest m;
    m.version = CATHLAB_VERSION;
    m.scene = path_for_manifest(scene.path, context.data_root);
    for (const std::string& overlay : overlays) m.overlays.push_back(path_for_manifest(overlay, context.data_root));
    m.scene_name = scene.name;
    m.scene_hash = scene.hash;
    m.anatomy_hash = anatomy_hash;
    m.dt_s = scene.step.dt_s;
    m.host = host_text();
    m.started_utc = utc_now();
    return m;
}

}  // namespace cathlab
