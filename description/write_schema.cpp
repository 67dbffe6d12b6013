// Writes docs/reference/scene.schema.json to standard output. With the name of a guide as argument, writes
// that guide with its key tables regenerated instead. Part of the target `reference`.
#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>

#include "description/load.h"

int main(int argc, char** argv) {
  std::string text;
  if (argc > 1) {
    std::ifstream guide(argv[1], std::ios::binary);
    text = abbe::scene_guide({std::istreambuf_iterator<char>(guide), {}});
  } else {
    text = abbe::scene_schema();
  }
  return text.empty() || std::fputs(text.c_str(), stdout) < 0 ? 1 : 0;
}
