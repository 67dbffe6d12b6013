// What the lines at the head of a Radiance picture say [Radiance].
#include <algorithm>
#include <fstream>
#include <sstream>
#include <vector>

#include "io/error.h"
#include "io/picture_module.h"

namespace abbe::picture_module {
namespace {

// The numbers of a line after its "KEY=", of which there must be so many.
std::vector<double> numbers_of(const std::string& line, std::size_t count, const std::string& path) {
  std::istringstream words(line.substr(line.find('=') + 1));
  std::vector<double> numbers;
  for (double number = 0; words >> number;) numbers.push_back(number);
  if (!words.eof() || numbers.size() != count)
    throw Error(ErrorCode::input, path,
                "numbers expected (got \"" + line + "\", allowed " + std::to_string(count) + ")");
  return numbers;
}

// Multiplies them by those of a line, of one for all or one for each.
void take_factors(const std::string& line, std::size_t count, const std::string& path,
                  std::array<double, 3>& factors) {
  const std::vector<double> told = numbers_of(line, count, path);
  if (std::ranges::any_of(told, [](double factor) { return !(factor > 0); }))
    throw Error(ErrorCode::input, path, "pixels were multiplied by (got \"" + line + "\", allowed > 0)");
  for (std::size_t c = 0; c < 3; ++c) factors.at(c) *= told[c % count];
}

// "" of zeros, by which some programs mean that they do not say.
std::string primaries_of(const std::string& line, const std::string& path) {
  const std::vector<double> told = numbers_of(line, 8, path);
  if (std::ranges::all_of(told, [](double number) { return number == 0; })) return "";
  return numbers_text(told);
}

void read_line(const std::string& line, const std::string& path, RadianceHeader& header) {
  if (line.starts_with("EXPOSURE=")) take_factors(line, 1, path, header.factors);
  if (line.starts_with("COLORCORR=")) take_factors(line, 3, path, header.factors);
  if (line.starts_with("PRIMARIES=")) header.primaries = primaries_of(line, path);
  if (line.starts_with("GAMMA=") && numbers_of(line, 1, path).front() != 1)
    throw Error(ErrorCode::input, path, "values are not linear (got \"" + line + "\", allowed GAMMA=1)");
}

// Of the line "-Y 600 +X 800", whose first axis runs from row to row and the second along them; X counts to
// the right, and Y upwards.
int orientation_of(const std::string& line) {
  const bool from_right = line.find("-X") != std::string::npos;
  const bool from_bottom = line.find("+Y") != std::string::npos;
  const bool rows_are_columns = line.find('X') < line.find('Y');
  const int round = from_bottom ? (from_right ? 2 : 3) : (from_right ? 1 : 0);
  return 1 + round + (rows_are_columns ? 4 : 0);
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
