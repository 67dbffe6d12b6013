#include "description/meshes/obj_lines.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>

#include "io/text.h"

namespace abbe {

std::string without_comment(std::string_view text) {
  const std::size_t hash = std::min(text.find(" #"), text.find("\t#"));
  return split(text.substr(0, hash), '\n')[0];
}

void erase_comments(std::string& bytes) {
  std::size_t written = 0;
  for (std::size_t begin = 0; begin < bytes.size();) {
    const std::size_t end = std::min(bytes.find('\n', begin), bytes.size() - 1) + 1;
    const std::string_view line = std::string_view(bytes).substr(begin, end - begin);
    const std::size_t key = std::min(line.find_first_not_of(" \t"), line.size());
    const bool named = line.substr(key).starts_with("usemtl") || line.substr(key).starts_with("mtllib");
    std::size_t length = named ? line.size() : std::min(line.find('#'), line.size());
    while (!named && length < line.size() && length > 0 &&
           (line[length - 1] == ' ' || line[length - 1] == '\t'))
      --length;
    const bool cut = length < line.size() && line.back() == '\n';
    std::memmove(&bytes[written], &bytes[begin], length);
    written += length;
    if (cut) bytes[written++] = '\n';
    begin = end;
  }
  bytes.resize(written);
}

void join_continued_lines(std::string& bytes) {
  std::size_t written = 0;
  std::size_t joined = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const std::string_view rest = std::string_view(bytes).substr(i);
    if (rest.starts_with("\\\n") || rest.starts_with("\\\r\n")) {
      i = bytes.find('\n', i);
      bytes[written++] = ' ';
      ++joined;
      continue;
    }
    bytes[written++] = bytes[i];
    if (bytes[i] != '\n') continue;
    for (; joined > 0; --joined) bytes[written++] = '\n';
  }
  bytes.resize(written);
}

}  // namespace abbe
