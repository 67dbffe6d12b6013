// Writes docs/scene.schema.json to standard output: a part of the target `reference`.
#include <cstdio>

#include "description/scene_schema.h"

int main() {
  return std::fputs(abbe::scene_schema().c_str(), stdout) < 0 ? 1 : 0;
}
