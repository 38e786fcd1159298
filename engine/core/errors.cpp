#include "core/errors.h"

#include <algorithm>
#include <cstddef>

namespace cathlab {

std::string SourcePlace::text() const {
    std::string out = file;
    if (line > 0) out += ":" + std::to_string(line);
    if (!key.empty()) out += (out.empty() ? "" : ": ") + key;
    return out;
}

UserError::UserError(const std::string& sentence, bool wrong_use)
    : std::runtime_error(sentence), wrong_use_(wrong_use) {}

UserError::UserError(const SourcePlace& where, const std::string& sentence)
    : std::runtime_error(where.text() + ": " + sentence) {}

namespace {

std::size_t edit_distance(const std::string& a, const std::string& b) {
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t substitute = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
            diagonal = row[j];
            row[j] = std::min({substitute, row[j] + 1, row[j - 1] + 1});
        }
    }
    return row[b.size()];
}

}  // namespace

std::string nearest_name(const std::string& found, const std::vector<std::string>& known) {
    if (found.empty() || found.size() > 200) return "";  // nobody mistypes a name of 200 letters
    std::string best;
    std::size_t best_distance = std::max<std::size_t>(3, found.size() / 2) + 1;
    for (const std::string& name : known) {
        const std::size_t distance = edit_distance(found, name);
        if (distance < best_distance) {
            best_distance = distance;
            best = name;
        }
    }
    return best;
}

std::string did_you_mean(const std::string& found, const std::vector<std::string>& known) {
    const std::string name = nearest_name(found, known);
    return name.empty() ? "" : "; did you mean '" + name + "'?";
}

std::string comma_list(const std::vector<std::string>& names) {
    std::string out;
    for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name;
    return out;
}

}  // namespace cathlab
