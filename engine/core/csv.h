// Tables as text: lines cut at commas into cells, and numbers read from them.  No cell spans lines and none is quoted:
// a quote is a character like any other.
#pragma once

#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace cathlab {

/// Without the spaces and tabs round it, and without the carriage returns that end a line on other systems.
std::string_view trimmed(std::string_view text);

/// The trimmed cells of a line, at least one; views into `line`.  From the 10,000th comma on nothing is cut, so that a
/// file of commas cannot fill the memory.
std::vector<std::string_view> cells_of(std::string_view line);

/// A user's text as a sentence may show it: at most `longest` bytes, no broken UTF-8 character at its end, and a '?'
/// for everything that a terminal would obey (C0 and C1 controls, DEL) or that is no UTF-8.
std::string shown(std::string_view text, std::size_t longest = 60);

/// The number that the whole text is, as std::from_chars reads it: no sign '+', no spaces, no hexadecimal digits; the
/// words nan, inf and infinity are numbers of a floating T.  Nothing where it is none or does not fit into T.
template <class T>
std::optional<T> parse_number(std::string_view text) {
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
}

/// The finite number that the whole cell is; one '+' may stand before its digits.
std::optional<double> finite_number(std::string_view cell);

/// Walks through a text line by line.  Passed over are a byte order mark at its begin, empty lines, and comments: lines
/// whose first character other than a space is '#'.  The text must outlive the walk.
class CsvLines {
public:
    explicit CsvLines(std::string_view text);

    /// Goes to the next line that holds cells; false at the end.
    bool next();

    int number() const { return number_; }           ///< of the line in the file, from 1
    std::string_view text() const { return text_; }  ///< of the line, trimmed
    std::vector<std::string_view> cells() const { return cells_of(text_); }

private:
    std::string_view rest_, text_;
    int number_ = 0;
};

}  // namespace cathlab
