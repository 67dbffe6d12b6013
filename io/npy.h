#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "io/inputs.h"

namespace abbe {

/// An array of numbers, the last axis running fastest.
struct NumberArray {
  std::vector<std::size_t> shape;
  std::vector<float> values;
};

/// The most values that are read from one file.
inline constexpr std::size_t kMaxArrayValues = std::size_t{1} << 28U;

/// Reads a file that NumPy's `save` wrote: format 1 or 2, little-endian floats of 4 or 8 bytes in C order.
/// Throws Error{input} for one that is missing, of another kind, cut or too long, Error{resource} for too
/// many values.
[[nodiscard]] NumberArray read_npy(const std::filesystem::path& path, Inputs* inputs = nullptr);

}  // namespace abbe
