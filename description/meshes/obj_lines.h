#pragma once

#include <string>
#include <string_view>

// Preprocessing of the lines of an .obj file for the library that reads them.
namespace abbe {

/// The text before the first "#" that follows a blank or a tab, without leading and trailing blanks. `text`
/// is at most one line. A "#" at the beginning or within a word belongs to the result.
[[nodiscard]] std::string without_comment(std::string_view text);
/// Removes each "#" and the rest of its line, with the blanks before it, because the library reads words
/// after the numbers of a line as further numbers. Line breaks stay. Lines that begin with `usemtl` or
/// `mtllib` stay unchanged, because their names may contain a "#": see `without_comment`.
void erase_comments(std::string& bytes);
/// Joins lines that a "\" at their end continues; a blank replaces the "\" and the line break. Adds as many
/// empty lines after the joined line, so that the numbers of later lines stay the same.
void join_continued_lines(std::string& bytes);

}  // namespace abbe
