#include "core/csv.h"

#include <algorithm>
#include <cmath>

namespace cathlab {
namespace {

constexpr std::size_t most_cuts = 9999;

unsigned byte_at(std::string_view text, std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
}

/// Bytes of the UTF-8 character that begins at i; 0 where none does, or one that a terminal would obey.
std::size_t character_size(std::string_view text, std::size_t i) {
    const unsigned first = byte_at(text, i);
    if (first < 0x80U) return first >= 0x20U && first != 0x7FU ? 1 : 0;
    const std::size_t size = first >= 0xC2U && first < 0xE0U   ? 2
                             : first >= 0xE0U && first < 0xF0U ? 3
                             : first >= 0xF0U && first < 0xF5U ? 4
                                                               : 0;
    for (std::size_t k = 1; k < size; ++k)
        if ((byte_at(text, i + k) & 0xC0U) != 0x80U) return 0;
    const unsigned second = byte_at(text, i + 1);
    const bool control = first == 0xC2U && second < 0xA0U;
    const bool too_long = (first == 0xE0U && second < 0xA0U) || (first == 0xF0U && second < 0x90U);
    return control || too_long ? 0 : size;
}

}  // namespace

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t' || text.back() == '\r')) text.remove_suffix(1);
    return text;
}

std::vector<std::string_view> cells_of(std::string_view line) {
    std::vector<std::string_view> out;
    for (;;) {
        const auto comma = out.size() < most_cuts ? line.find(',') : std::string_view::npos;
        out.push_back(trimmed(line.substr(0, comma)));
        if (comma == std::string_view::npos) return out;
        line.remove_prefix(comma + 1);
    }
}

std::string shown(std::string_view text, std::size_t longest) {
    std::string out;
    for (std::size_t i = 0; i < text.size();) {
        const std::size_t size = character_size(text, i);
        if (out.size() + std::max<std::size_t>(size, 1) > longest) break;
        if (size == 0)
            out += '?';
        else
            out += text.substr(i, size);
        i += std::max<std::size_t>(size, 1);
    }
    return out;
}

std::optional<double> finite_number(std::string_view cell) {
    const bool plus = !cell.empty() && cell.front() == '+';
    if (plus) cell.remove_prefix(1);
    if (plus && !cell.empty() && cell.front() == '-') return std::nullopt;
    const auto value = parse_number<double>(cell);
    return value && std::isfinite(*value) ? value : std::nullopt;
}

CsvLines::CsvLines(std::string_view text) : rest_(text) {
    if (rest_.substr(0, 3) == "\xEF\xBB\xBF") rest_.remove_prefix(3);
}

bool CsvLines::next() {
    while (!rest_.empty()) {
        ++number_;
        const auto end = rest_.find('\n');
        text_ = trimmed(rest_.substr(0, end));
        rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
        if (!text_.empty() && text_.front() != '#') return true;
    }
    text_ = {};
    return false;
}

}  // namespace cathlab
