#pragma once

#include <filesystem>
#include <optional>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include "io/image.h"
#include "io/spectral_exr.h"
#include "transport/render/part.h"

namespace abbe::python {

/// A film in Python. It has the exact sums if it was rendered or read from a part, and the image that its
/// file contains.
class FilmHandle {
 public:
  explicit FilmHandle(RenderPart part);
  explicit FilmHandle(Image image);

  /// Content of the film's file. It is computed once from the exact sums; callers hold the GIL.
  [[nodiscard]] const Image& image() const;
  /// Exact sums; nothing for a film read from an image.
  [[nodiscard]] const std::optional<RenderPart>& part() const { return part_; }
  [[nodiscard]] const std::map<std::string, std::string>& metadata() const { return image().metadata; }

  /// Names of the channels in the order of the sensor, or of the bands by ascending wavelength.
  [[nodiscard]] std::vector<std::string> channels() const;
  /// Read-only array of rows, columns and channels, made once.
  [[nodiscard]] pybind11::object array() const;
  /// Variances of the pixel means in the same layout; None if the film does not record them or they are
  /// unknown.
  [[nodiscard]] pybind11::object variance() const;

 private:
  std::optional<RenderPart> part_;
  mutable std::optional<Image> image_;
  mutable pybind11::object array_;
  mutable pybind11::object variance_;
};

/// Array of rows, columns and the named planes, which have the same size. None if the image lacks one of
/// them.
[[nodiscard]] pybind11::object planes_of(const Image& image, const std::vector<std::string>& names);

/// Adds the class of films and `merge`.
void add_film(pybind11::module_& module);

}  // namespace abbe::python
