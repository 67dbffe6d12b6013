// Prints the verdicts of the scene reader on scenes, for comparison with another validator:
//
//   scene_verdicts examples   writes the scenes of the tree and the guide's examples, each as a line of JSON
//   scene_verdicts            answers each line of standard input, a scene, by "ok" or the first complaint
//
// The verdict covers the key tables only, not errors found while building the scene, such as unknown names.
#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "description/scene.h"
#include "io/schema/read.h"
#include "tests/description/examples.h"

namespace abbe {
namespace {

std::optional<JsonValue> parse(const std::string& text, Diagnostics& diagnostics) {
  return parse_json(std::make_shared<const SourceText>(SourceText{"scene", text}), diagnostics);
}

void write_example(const std::string& text) {
  Diagnostics diagnostics;
  const std::optional<JsonValue> scene = parse(text, diagnostics);
  if (!scene) throw std::runtime_error(diagnostics.text());
  std::cout << to_text(*scene) << '\n';
}

std::string verdict(const std::string& text) {
  Diagnostics diagnostics;
  const std::optional<JsonValue> json = parse(text, diagnostics);
  if (json && schema::read<spec::Scene>(*json, diagnostics)) return "ok";
  const Diagnostic& first = diagnostics.all().front();
  std::string line = first.where.pointer + ": " + first.message;
  std::replace(line.begin(), line.end(), '\n', ' ');
  return line;
}

}  // namespace
}  // namespace abbe

int main(int count, char**) {
  using namespace abbe;
  if (count > 1) {
    for (const char* folder : {"scenes", "bench"})
      for (const auto& path : test::scene_files(folder)) write_example(test::file_text(path));
    for (const std::string& example : test::guide_examples()) write_example(test::completed(example));
    return 0;
  }
  for (std::string line; std::getline(std::cin, line);) std::cout << verdict(line) << '\n';
}
