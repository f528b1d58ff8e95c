// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>

namespace osteon::io {

// Walks over the words of a text, line by line. Works on a view: nothing is copied. '\n', "\r\n" and '\r' end a line.
class TextScanner {
 public:
  explicit TextScanner(std::string_view text) : at_(text.data()), end_(text.data() + text.size()) {
    if (text.starts_with("\xEF\xBB\xBF")) at_ += 3;
  }

  bool at_end() const { return at_ == end_; }
  std::size_t line() const { return line_; }  // from 1
  std::size_t bytes_left() const { return static_cast<std::size_t>(end_ - at_); }

  // The next word of this line; empty at its end.
  std::string_view word() {
    skip_blanks();
    const char* begin = at_;
    while (at_ != end_ && !is_blank(*at_) && !is_line_end(*at_)) ++at_;
    return {begin, static_cast<std::size_t>(at_ - begin)};
  }

  // The next word, on whatever line; empty at the end of the text.
  std::string_view word_on_any_line() {
    std::string_view next = word();
    while (next.empty() && !at_end()) {
      next_line();
      next = word();
    }
    return next;
  }

  // The rest of this line without blanks at either end.
  std::string_view rest() {
    skip_blanks();
    const char* begin = at_;
    while (at_ != end_ && !is_line_end(*at_)) ++at_;
    const char* last = at_;
    while (last != begin && is_blank(last[-1])) --last;
    return {begin, static_cast<std::size_t>(last - begin)};
  }

  bool at_line_end() {
    skip_blanks();
    return at_ == end_ || is_line_end(*at_);
  }

  void next_line() {
    while (at_ != end_ && !is_line_end(*at_)) ++at_;
    if (at_ == end_) return;
    const char first = *at_++;
    if (first == '\r' && at_ != end_ && *at_ == '\n') ++at_;
    ++line_;
  }

  // The next word as a number; NaN if it is none, and if the line is over.
  float number() { return to_number(word()); }

  static float to_number(std::string_view word) {
    if (word.starts_with('+')) word.remove_prefix(1);
    float value = NAN;
    const auto [end, failure] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (failure == std::errc::result_out_of_range) return out_of_range(word);
    return failure == std::errc() && end == word.data() + word.size() ? value : NAN;
  }

  static std::optional<std::int64_t> to_integer(std::string_view word) {
    if (word.starts_with('+')) word.remove_prefix(1);
    std::int64_t value = 0;
    const auto [end, failure] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (failure != std::errc() || end != word.data() + word.size()) return std::nullopt;
    return value;
  }

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\0' || c == '\v' || c == '\f'; }
  static bool is_line_end(char c) { return c == '\n' || c == '\r'; }
  // Too small to tell from zero, or too large.
  static float out_of_range(std::string_view word) {
    double value = NAN;
    std::from_chars(word.data(), word.data() + word.size(), value);
    return static_cast<float>(std::abs(value) < 1.0 ? value : NAN);
  }
  // A backslash before the line's end joins the next line to this one (OBJ).
  void skip_blanks() {
    while (at_ != end_) {
      if (is_blank(*at_)) {
        ++at_;
      } else if (*at_ == '\\' && at_ + 1 != end_ && is_line_end(at_[1])) {
        ++at_;
        next_line();
      } else {
        break;
      }
    }
  }

  const char* at_;
  const char* end_;
  std::size_t line_ = 1;
};

}  // namespace osteon::io
