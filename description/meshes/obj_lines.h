#pragma once

#include <string>
#include <string_view>

// The lines of an .obj file, as the library that reads them takes them.
namespace abbe {

/// What comes before a "#" that follows a blank, without blanks at its ends.
[[nodiscard]] std::string without_comment(std::string_view text);
/// Takes comments out of a file: the library takes what is behind numbers for numbers. Lines of names, which
/// may have a "#" in them, stay as they are.
void erase_comments(std::string& bytes);
/// Puts lines that a "\" at the end continues into one, and as many ends of lines behind it, so that lines
/// keep their numbers.
void join_continued_lines(std::string& bytes);

}  // namespace abbe
