#include "io/npy.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <fstream>
#include <string>

#include <fmt/format.h>

#include "io/error.h"
#include "io/text.h"

namespace abbe {
namespace {

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little);

constexpr std::string_view kMagic("\x93NUMPY", 6);
constexpr std::size_t kMaxArrayHeaderBytes = std::size_t{1} << 16U;

[[noreturn]] void refuse_array(const fs::path& path, const std::string& message) {
  throw Error(ErrorCode::input, path.string(), message);
}

// The header, which is a Python dictionary as text, and the offset of the numbers.
struct ArrayHeader {
  std::string text;
  std::size_t end;
};
ArrayHeader read_array_header(std::istream& file, const fs::path& path) {
  std::array<char, 12> start{};
  file.read(start.data(), start.size());
  if (file.gcount() != std::ssize(start) || std::string_view(start.data(), kMagic.size()) != kMagic)
    refuse_array(path, "not a NumPy array");
  const auto byte = [&start](std::size_t i) {
    return static_cast<std::size_t>(static_cast<unsigned char>(start.at(i)));
  };
  const std::size_t version = byte(6);
  if (version != 1 && version != 2)
    refuse_array(path, fmt::format("unsupported format version (got {}, allowed 1 or 2)", version));
  const std::size_t first = version == 1 ? 10 : 12;
  std::size_t length = byte(8) + 256 * byte(9);
  if (version == 2) length += 65536 * (byte(10) + 256 * byte(11));
  if (length > kMaxArrayHeaderBytes) refuse_array(path, "damaged header");
  ArrayHeader header{std::string(length, '\0'), first + length};
  file.seekg(static_cast<std::streamoff>(first));
  file.read(header.text.data(), static_cast<std::streamsize>(length));
  if (static_cast<std::size_t>(file.gcount()) != length) refuse_array(path, "damaged header");
  return header;
}

// The text after `'key':` in the dictionary.
std::string_view value_of(std::string_view text, std::string_view key, const fs::path& path) {
  const std::string quoted = fmt::format("'{}':", key);
  const std::size_t at = text.find(quoted);
  if (at == std::string_view::npos) refuse_array(path, fmt::format("the header has no {}", key));
  text.remove_prefix(at + quoted.size());
  text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
  return text;
}

// Lengths of the axes in a Python tuple, such as "(3, 4)" or "(3,)".
std::vector<std::size_t> shape_of(std::string_view text, const fs::path& path) {
  std::vector<std::size_t> shape;
  if (!text.starts_with('(')) refuse_array(path, "damaged header");
  text.remove_prefix(1);
  while (!text.starts_with(')')) {
    std::size_t length = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), length);
    if (error != std::errc() || shape.size() == 32) refuse_array(path, "damaged header");
    shape.push_back(length);
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    text.remove_prefix(std::min(text.find_first_not_of(", "), text.size()));
    if (text.empty()) refuse_array(path, "damaged header");
  }
  return shape;
}

// Product of the lengths. Throws Error{resource} above kMaxArrayValues.
std::size_t count_of(const std::vector<std::size_t>& shape, const fs::path& path) {
  std::size_t count = 1;
  for (const std::size_t length : shape) {
    if (length > kMaxArrayValues || count * length > kMaxArrayValues)
      throw Error(ErrorCode::resource, path.string(),
                  fmt::format("has more than {} values", kMaxArrayValues));
    count *= length;
  }
  return count;
}

template <typename T>
std::vector<float> read_values(std::istream& file, std::size_t count) {
  std::vector<T> raw(count);
  file.read(reinterpret_cast<char*>(raw.data()), static_cast<std::streamsize>(count * sizeof(T)));
  return {raw.begin(), raw.end()};
}

}  // namespace

NumberArray read_npy(const fs::path& path, Inputs* inputs) {
  require_file(path);
  std::ifstream file(path, std::ios::binary);
  if (!file) refuse_array(path, "cannot be read");
  const ArrayHeader header = read_array_header(file, path);
  if (value_of(header.text, "fortran_order", path).starts_with("True"))
    refuse_array(path, "values are in Fortran order (allowed C order)");
  const std::string_view type = value_of(header.text, "descr", path);
  const bool wide = type.starts_with("'<f8'");
  if (!wide && !type.starts_with("'<f4'"))
    refuse_array(path, fmt::format("unsupported type of numbers (got {}, allowed '<f4' or '<f8')",
                                   type.substr(0, type.find(','))));
  NumberArray array{shape_of(value_of(header.text, "shape", path), path), {}};
  const std::size_t count = count_of(array.shape, path);
  std::error_code error;
  const std::uintmax_t bytes = fs::file_size(path, error);  // Checked before memory is allocated.
  if (error || bytes != header.end + count * (wide ? 8 : 4))
    refuse_array(path, fmt::format("the file size does not fit its {} values", count));
  if (inputs) inputs->reserve_memory(path.string(), count * (wide ? 8 + 4 : 2 * 4));
  file.seekg(static_cast<std::streamoff>(header.end));
  array.values = wide ? read_values<double>(file, count) : read_values<float>(file, count);
  if (!file) refuse_array(path, "cannot be read");
  if (inputs) inputs->release_memory(count * (wide ? 8 : 4));  // The copy with the type of the file.
  return array;
}

}  // namespace abbe
