#pragma once

#include <filesystem>
#include <optional>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include "io/image.h"
#include "io/spectral_exr.h"
#include "transport/render/part.h"

namespace abbe::python {

/// A film as Python holds it: with its exact sums where it was rendered or read from a part, and as the image
/// that its file holds.
class FilmHandle {
 public:
  explicit FilmHandle(RenderPart part);
  explicit FilmHandle(Image image);

  /// What the film's file holds; made once of the exact sums, under Python's lock, which callers hold.
  [[nodiscard]] const Image& image() const;
  /// The exact sums; nothing for a film read from an image.
  [[nodiscard]] const std::optional<RenderPart>& part() const { return part_; }
  [[nodiscard]] const std::map<std::string, std::string>& metadata() const { return image().metadata; }

  /// The channels of its values in the order of the sensor, or of the bands by ascending wavelength.
  [[nodiscard]] std::vector<std::string> channels() const;
  /// Rows, columns, channels; made once, read-only.
  [[nodiscard]] pybind11::object array() const;
  /// The same of variances of pixel means; None for a film that does not tell them or does not know.
  [[nodiscard]] pybind11::object variance() const;

 private:
  std::optional<RenderPart> part_;
  mutable std::optional<Image> image_;
  mutable pybind11::object array_;
  mutable pybind11::object variance_;
};

/// Planes of one size side by side: rows, columns, planes. None when the image lacks one of them.
[[nodiscard]] pybind11::object planes_of(const Image& image, const std::vector<std::string>& names);

/// Adds the classes of films, and `merge`.
void add_film(pybind11::module_& module);

}  // namespace abbe::python
