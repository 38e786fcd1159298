// The user's mistakes: one sentence that says where, what was found, what is allowed, and the nearest known name.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace cathlab {

/// A place in a user's file.  line 0 = the whole file; an empty key = no particular key.
struct SourcePlace {
    std::string file;
    int line = 0;
    std::string key;

    /// "scene.toml:12: [wire] insertion_mm" as far as the parts are known.
    std::string text() const;
};

/// The work cannot go on because of something the user can mend.  app turns it into one line and an exit code.
class UserError : public std::runtime_error {
public:
    /// wrong_use: the command line itself was wrong (exit code 2); otherwise the work failed (exit code 1).
    explicit UserError(const std::string& sentence, bool wrong_use = false);
    UserError(const SourcePlace& where, const std::string& sentence);
    bool wrong_use() const { return wrong_use_; }

private:
    bool wrong_use_ = false;
};

/// The known name with the smallest edit distance to `found`, or "" when none is near (distance above half its length,
/// or 3).
std::string nearest_name(const std::string& found, const std::vector<std::string>& known);

/// "; did you mean 'x'?" or "" for appending to a sentence.
std::string did_you_mean(const std::string& found, const std::vector<std::string>& known);

/// "a, b, c" for sentences that list what is allowed.
std::string comma_list(const std::vector<std::string>& names);

}  // namespace cathlab
