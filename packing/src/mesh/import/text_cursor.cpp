#include "mesh/import/text_cursor.hpp"

#include <algorithm>
#include <charconv>
#include <limits>

namespace innersphere {
namespace {

char small(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

bool isBlank(char c) {
  return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}

// Whether a number that no double can hold is so because it is too small. std::from_chars does not tell.
bool isTiny(std::string_view word) {
  const std::size_t exponent = word.find_first_of("eE");
  if (exponent != std::string_view::npos) return word[exponent + 1] == '-';
  return word.find_first_not_of("-0") == word.find('.');
}

}  // namespace

bool TextCursor::nextLine() {
  while (!atLineEnd()) ++at_;
  if (at_ == bytes_.size()) return false;
  if (bytes_[at_] == '\r' && at_ + 1 < bytes_.size() && bytes_[at_ + 1] == '\n') ++at_;
  ++at_;
  ++line_;
  return true;
}

std::string_view TextCursor::wordInLine() {
  while (!atLineEnd()) {
    if (isBlank(bytes_[at_])) {
      ++at_;
    } else if (continues_ != 0 && bytes_[at_] == continues_) {
      ++at_;
      if (atLineEnd()) nextLine();
    } else {
      break;
    }
  }
  if (!atLineEnd() && comment_ != 0 && bytes_[at_] == comment_) {
    while (!atLineEnd()) ++at_;
  }
  const std::size_t first = at_;
  while (!atLineEnd() && !isBlank(bytes_[at_]) && (continues_ == 0 || bytes_[at_] != continues_)) ++at_;
  return bytes_.substr(first, at_ - first);
}

std::string_view TextCursor::word() {
  std::string_view found = wordInLine();
  while (found.empty() && nextLine()) found = wordInLine();
  return found;
}

double TextCursor::numberFrom(std::string_view word) const {
  if (word.empty()) fail("a number is missing");
  const char* first = word.data() + (word[0] == '+' ? 1 : 0);
  const char* last = word.data() + word.size();
  double value = 0;
  const auto [end, error] = std::from_chars(first, last, value);
  if (error == std::errc::result_out_of_range && end == last) {
    return isTiny(word) ? 0 : std::numeric_limits<double>::infinity();
  }
  if (error != std::errc() || end != last) fail(quoted(word) + " is no number");
  return value;
}

std::int64_t TextCursor::integerFrom(std::string_view word) const {
  if (word.empty()) fail("a whole number is missing");
  const char* last = word.data() + word.size();
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(word.data() + (word[0] == '+' ? 1 : 0), last, value);
  if (error != std::errc() || end != last) fail(quoted(word) + " is no whole number that can be used");
  return value;
}

void TextCursor::expect(std::string_view expected) {
  const std::string_view found = word();
  if (sameWord(found, expected)) return;
  const std::string wanted = quoted(expected) + " is expected, ";
  fail(found.empty() ? wanted + "but the file ends; it was cut, copy or export it again"
                     : wanted + "not " + quoted(found));
}

void TextCursor::fail(const std::string& what, ErrorCode code) const {
  throw Error(code, path_ + ", line " + std::to_string(line_) + ": " + what);
}

bool sameWord(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](char x, char y) { return small(x) == small(y); });
}

std::string quoted(std::string_view word) {
  constexpr std::size_t kMost = 40;
  std::string text(word.substr(0, kMost));
  for (char& c : text) {
    if (c < ' ' || c > '~') c = '.';
  }
  if (word.size() > kMost) text += "...";
  text.insert(0, 1, '"');
  text += '"';
  return text;
}

}  // namespace innersphere
