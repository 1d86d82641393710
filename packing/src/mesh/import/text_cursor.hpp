// Walks through a mesh file that people can read, and knows its line.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "innersphere/error.hpp"

namespace innersphere {

/// Gives the words of a text one after the other. Words end at white space; a line ends at LF, CR or both.
class TextCursor {
 public:
  /// The bytes have to outlive the cursor; `path` is for messages. `comment` begins what is skipped up to the
  /// end of its line, 0 for none. `continues` makes one line of two where it is the last of the first.
  TextCursor(std::string_view bytes, const std::string& path, char comment = 0, char continues = 0)
      : bytes_(bytes), path_(path), comment_(comment), continues_(continues) {
    if (bytes_.substr(0, kByteOrderMark.size()) == kByteOrderMark) at_ = kByteOrderMark.size();
  }

  /// Returns the next word of this line, empty at its end.
  std::string_view wordInLine();
  /// Returns the next word of this line or of the lines after it, empty at the end of the file.
  std::string_view word();
  /// Goes behind the end of this line. False if it was the last of the file.
  bool nextLine();

  /// Return the next word, as a number; they fail if it is none. Numbers too large for a double are infinite.
  double number() { return numberFrom(word()); }
  double numberInLine() { return numberFrom(wordInLine()); }
  std::int64_t integer() { return integerFrom(word()); }
  double numberFrom(std::string_view word) const;
  std::int64_t integerFrom(std::string_view word) const;
  /// Fails unless the next word is this one, in capital or small letters.
  void expect(std::string_view expected);

  std::size_t line() const { return line_; }
  std::size_t place() const { return line_; }  ///< What messages about a face name.
  std::size_t offset() const { return at_; }   ///< bytes
  std::size_t left() const { return bytes_.size() - at_; }
  /// Throws Error with the file and the line.
  [[noreturn]] void fail(const std::string& what, ErrorCode code = ErrorCode::bad_format) const;

 private:
  /// Some editors begin a text in UTF-8 with it.
  static constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

  bool atLineEnd() const { return at_ == bytes_.size() || bytes_[at_] == '\n' || bytes_[at_] == '\r'; }

  std::string_view bytes_;
  const std::string& path_;
  char comment_, continues_;
  std::size_t at_ = 0;
  std::size_t line_ = 1;
};

/// Whether two words are the same but for capital letters.
bool sameWord(std::string_view a, std::string_view b);

/// Returns a word for a message: in quotes, cut if it is long, with dots for what cannot be printed.
std::string quoted(std::string_view word);

}  // namespace innersphere
