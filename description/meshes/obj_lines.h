#pragma once

#include <string>
#include <string_view>

// Preprocessing of the lines of an .obj file for the library that reads them.
namespace abbe {

/// The text before a "#" that follows a blank, without leading and trailing blanks.
[[nodiscard]] std::string without_comment(std::string_view text);
/// Removes comments, because the library reads words after the numbers of a line as further numbers. Lines
/// with names, which may contain a "#", stay unchanged.
void erase_comments(std::string& bytes);
/// Joins lines that a "\" at their end continues. Adds as many empty lines after them, so that line numbers
/// stay the same.
void join_continued_lines(std::string& bytes);

}  // namespace abbe
