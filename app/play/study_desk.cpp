#include "play/study_desk.h"

#include <filesystem>

#include "core/errors.h"
#include "trial_run.h"

namespace cathlab::play {
namespace fs = std::filesystem;

StudyDesk::StudyDesk(const std::string& study, const std::string& participant, const AppContext& context)
    : context_(context), study_(study), participant_(participant), protocol_(read_study(study)) {
    std::vector<std::string> names;
    for (const Participant& p : read_participants(study_, protocol_)) {
        if (p.pseudonym == participant_ && p.synthetic)
            throw UserError("'" + participant_ + "' is a synthetic participant of " + study_ + ": no person");
        names.push_back(p.pseudonym);
    }
    if (std::find(names.begin(), names.end(), participant_) == names.end())
        throw UserError("'" + participant_ + "' takes no part in " + study_ + did_you_mean(participant_, names) +
                            " cathlab study add makes a participant",
                        true);
    look();
}

void StudyDesk::look() {
    next_.reset();
    done_ = total_ = 0;
    for (const Trial& trial : schedule(protocol_, read_participants(study_, protocol_))) {
        if (trial.participant != participant_) continue;
        ++total_;
        if (trial_done(study_, trial))
            ++done_;
        else if (!next_)
            next_ = trial;
    }
}

TaskScene StudyDesk::task() const {
    return load_task(task_scene(next_->task, context_), context_.data_root);
}

std::uint64_t StudyDesk::seed() const {
    return trial_seed(protocol_, *next_);
}

std::string StudyDesk::begin() {
    std::string part = folder() + ".part";
    std::error_code error;
    fs::remove_all(part, error);
    if (error) throw UserError(part + ": cannot be removed: " + error.message());
    return part;
}

std::string StudyDesk::keep() {
    std::string kept = folder();
    std::error_code error;
    fs::rename(kept + ".part", kept, error);
    if (error) throw UserError(kept + ": the trial cannot be kept: " + error.message());
    look();
    return kept;
}

}  // namespace cathlab::play
