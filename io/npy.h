#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "io/inputs.h"

namespace abbe {

/// A multidimensional array of numbers. The last axis varies fastest.
struct NumberArray {
  std::vector<std::size_t> shape;  ///< Length of each axis; empty for a single number.
  std::vector<float> values;
};

/// Largest number of values read from one file.
inline constexpr std::size_t kMaxArrayValues = std::size_t{1} << 28U;

/// Reads a `.npy` file of NumPy: format 1 or 2, little-endian floats of 4 or 8 bytes in C order. `inputs`, if
/// not nullptr, reserves the memory of the values, which stays reserved. Throws Error{input} if the file is
/// missing, has another format, or has too few or too many bytes. Throws Error{resource} for more than
/// kMaxArrayValues values, or more memory than is left in `inputs`.
[[nodiscard]] NumberArray read_npy(const std::filesystem::path& path, Inputs* inputs = nullptr);

}  // namespace abbe
