#include "record/manifest.h"

#include "record/json_lines.h"

namespace cathlab {

std::string manifest_json(const RunManifest& m) {
    const nlohmann::ordered_json out{{"schema", m.schema},
                                     {"version", m.version},
                                     {"scene", m.scene},
                                     {"overlays", m.overlays},
                                     {"scene_name", m.scene_name},
                                     {"scene_hash", hash_text(m.scene_hash)},
                                     {"anatomy_hash", hash_text(m.anatomy_hash)},
                                     {"script", m.script},
                                     {"seed", m.seed},
                                     {"dt_s", m.dt_s},
                                     {"threads", m.threads},
                                     {"host", m.host},
                                     {"started_utc", m.started_utc},
                                     {"wall_time_s", m.wall_time_s},
                                     {"steps", m.steps},
                                     {"video", m.video},
                                     {"complete", m.complete}};
    return out.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

RunManifest parse_manifest(const std::string& text, const std::string& file) {
    const SourcePlace where{file, 0, ""};
    JsonFields fields(parse_json(text, where), where);
    RunManifest m;
    fields.read("schema", m.schema);
    if (m.schema != 1)
        throw UserError({file, 0, "schema"}, "found " + std::to_string(m.schema) + "; this program reads 1");
    fields.read("version", m.version);
    fields.read("scene", m.scene);
    fields.read("overlays", m.overlays);
    fields.read("scene_name", m.scene_name);
    fields.read_hash("scene_hash", m.scene_hash);
    fields.read_hash("anatomy_hash", m.anatomy_hash);
    fields.read("script", m.script);
    fields.read("seed", m.seed);
    fields.read("dt_s", m.dt_s);
    fields.read("threads", m.threads);
    fields.read("host", m.host);
    fields.read("started_utc", m.started_utc);
    fields.read("wall_time_s", m.wall_time_s);
    fields.read("steps", m.steps);
    fields.read("video", m.video);
    fields.read("complete", m.complete);
    fields.done();
    if (!(m.dt_s > 0.0 && m.dt_s <= 1.0)) throw UserError({file, 0, "dt_s"}, "must lie between 0 and 1 s");
    if (m.steps < 0) throw UserError({file, 0, "steps"}, "must not be negative");
    return m;
}

}  // namespace cathlab
