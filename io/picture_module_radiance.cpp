// Reads the header of a Radiance picture [Radiance].
#include <algorithm>
#include <fstream>
#include <sstream>
#include <vector>

#include "io/error.h"
#include "io/picture_module.h"

namespace abbe::picture_module {
namespace {

// The numbers after "KEY=" in a line; throws unless there are `count`.
std::vector<double> numbers_of(const std::string& line, std::size_t count, const std::string& path) {
  std::istringstream words(line.substr(line.find('=') + 1));
  std::vector<double> numbers;
  for (double number = 0; words >> number;) numbers.push_back(number);
  if (!words.eof() || numbers.size() != count)
    throw Error(ErrorCode::input, path,
                "wrong count of numbers (got \"" + line + "\", allowed " + std::to_string(count) + ")");
  return numbers;
}

// Multiplies `factors` by the numbers of a line: one for all channels or one for each.
void take_factors(const std::string& line, std::size_t count, const std::string& path,
                  std::array<double, 3>& factors) {
  const std::vector<double> values = numbers_of(line, count, path);
  if (std::ranges::any_of(values, [](double factor) { return !(factor > 0); }))
    throw Error(ErrorCode::input, path,
                "factors of the pixels must be positive (got \"" + line + "\", allowed > 0)");
  for (std::size_t c = 0; c < 3; ++c) factors.at(c) *= values[c % count];
}

// Primaries of a line; "" for zeros, which some programs write for unknown primaries.
std::string primaries_of(const std::string& line, const std::string& path) {
  const std::vector<double> values = numbers_of(line, 8, path);
  if (std::ranges::all_of(values, [](double number) { return number == 0; })) return "";
  return numbers_text(values);
}

void read_line(const std::string& line, const std::string& path, RadianceHeader& header) {
  if (line.starts_with("EXPOSURE=")) take_factors(line, 1, path, header.factors);
  if (line.starts_with("COLORCORR=")) take_factors(line, 3, path, header.factors);
  if (line.starts_with("PRIMARIES=")) header.primaries = primaries_of(line, path);
  if (line.starts_with("GAMMA=") && numbers_of(line, 1, path).front() != 1)
    throw Error(ErrorCode::input, path, "values are not linear (got \"" + line + "\", allowed GAMMA=1)");
}

// Orientation from the line "-Y 600 +X 800". The first axis runs across rows, the second along them. +X
// points to the right, +Y upwards.
int orientation_of(const std::string& line) {
  const bool from_right = line.find("-X") != std::string::npos;
  const bool from_bottom = line.find("+Y") != std::string::npos;
  const bool rows_are_columns = line.find('X') < line.find('Y');
  const int quarter = from_bottom ? (from_right ? 2 : 3) : (from_right ? 1 : 0);
  return 1 + quarter + (rows_are_columns ? 4 : 0);
}

}  // namespace

RadianceHeader radiance_header(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  RadianceHeader header;
  std::string line;
  while (std::getline(file, line) && !line.empty()) read_line(line, path, header);
  std::getline(file, line);
  header.orientation = orientation_of(line);
  return header;
}

}  // namespace abbe::picture_module
