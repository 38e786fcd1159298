// A session's run folder, written as it goes.  A disk that fails ends the recording with a sentence and not the
// session.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "context.h"
#include "record/run_writer.h"
#include "scene/scene_spec.h"
#include "session.h"
#include "task/metrics.h"

namespace cathlab::play {

struct RecorderOptions {
    std::string folder;                 ///< new or empty
    std::vector<std::string> overlays;  ///< as the scene was loaded with; those inside the folder by their bare name
    std::string setup;  ///< text of setup.toml, "" = none: it lies in the folder already when the scene is loaded
    std::string trial;  ///< text of trial.json, "" = none
    int threads = 1;
};

class Recorder {
public:
    /// Throws UserError where the folder cannot be made or written.
    Recorder(const RecorderOptions& options, Session& session, const AppContext& context);
    ~Recorder();
    Recorder(const Recorder&) = delete;
    Recorder& operator=(const Recorder&) = delete;

    /// Before the step: what it is about to get.
    void before(const Input& input);
    /// After it.
    void after();
    /// To the disk, as far as a process can: call it at least twice a second.
    void flush();
    /// Another whole file of the folder.
    void file(const std::string& name, const std::string& text);
    /// Closes the folder; complete = the session came to its end.  Once.
    void finish(bool complete, double wall_time_s, const Metrics* metrics);

    const std::string& folder() const { return folder_; }
    /// "" or why the recording ended early.
    const std::string& fault() const { return fault_; }

private:
    template <class F>
    void guarded(F&& work);

    std::string folder_;
    Session& session_;
    std::optional<RunWriter> writer_;
    std::int64_t steps_ = 0;
    std::string fault_;
};

}  // namespace cathlab::play
