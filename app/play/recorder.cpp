#include "play/recorder.h"

#include <filesystem>

#include "core/errors.h"
#include "record/sums.h"
#include "run_facts.h"

namespace cathlab::play {
namespace fs = std::filesystem;

Recorder::Recorder(const RecorderOptions& options, Session& session, const AppContext& context)
    : folder_(options.folder), session_(session) {
    RunManifest manifest = manifest_of(session.scene(), options.overlays, session.anatomy_hash(), context);
    for (std::size_t i = 0; i < options.overlays.size(); ++i) {
        const fs::path overlay(options.overlays[i]);
        if (overlay.parent_path() == fs::path(folder_)) manifest.overlays[i] = overlay.filename().string();
    }
    manifest.seed = session.world().seed();
    manifest.threads = options.threads;
    writer_.emplace(folder_, manifest, session.entity_names());
    if (!options.trial.empty()) writer_->file("trial.json", options.trial);
}

Recorder::~Recorder() = default;

template <class F>
void Recorder::guarded(F&& work) {
    if (!writer_) return;
    try {
        work();
    } catch (const UserError& error) {
        fault_ = std::string("the recording has ended: ") + error.what();
        writer_.reset();
    }
}

void Recorder::before(const Input& input) {
    guarded([&] {
        if (RunWriter::wants_hash(steps_)) writer_->hash(steps_, session_.world().state_hash());
        writer_->input(steps_, input);
    });
}

void Recorder::after() {
    guarded([&] { writer_->step(steps_, session_.channels(), session_.events()); });
    ++steps_;
}

void Recorder::flush() {
    guarded([&] { writer_->flush(); });
}

void Recorder::file(const std::string& name, const std::string& text) {
    try {
        write_whole_file(folder_ + "/" + name, text);
    } catch (const UserError& error) {
        fault_ = error.what();
    }
}

void Recorder::finish(bool complete, double wall_time_s, const Metrics* metrics) {
    guarded([&] {
        if (steps_ > 0) writer_->hash(steps_, session_.world().state_hash());
        if (metrics != nullptr) writer_->file("metrics.json", metrics_json(*metrics));
        writer_->finish(steps_, complete, wall_time_s, "");
        write_sums(folder_);
    });
    writer_.reset();
}

}  // namespace cathlab::play
