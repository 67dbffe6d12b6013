#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "description/lens.h"
#include "description/lens_file_lines.h"

namespace abbe::description::zemax {

using lenses::Line;

/// Number of coefficients of an EVENASPH surface: those of r^2, r^4, ... r^16.
inline constexpr std::size_t kEvenCoefficients = 8;

/// A surface as read so far, with the data that decide the meaning of its lines. Lengths are in the file's
/// unit, also those of `surface`, until `Reader::finished` converts them to mm.
struct ReadSurface {
  spec::LensSurface surface;                     // Without radius, r2 and asphere.
  double curvature = 0;                          // Reciprocal of the radius [1/unit]; 0 for a plane.
  std::array<double, kEvenCoefficients> even{};  // Element i: coefficient of r^(2i+2) [unit^-(2i+1)].
  double semi_diameter = 0;                      // Half the diameter from DIAM.
  bool fixed = false;        // True if the diameter stops light: set by the user, or of a floating aperture.
  bool at_infinity = false;  // True for an object at infinity.
  bool has_type = false;
  bool standard = false;            // True for the type STANDARD, which has no parameters.
  std::optional<Line> parameter{};  // The first parameter that is not 0.
  bool has_curvature = false;
  bool has_thickness = false;
};

/// A wavelength and its weight.
struct ReadWavelength {
  double nm;
  double weight;  // Relative to those of the other wavelengths; only differences count.
  SourcePosition weight_where;
};

/// Reads a `.zmx` file line by line: first the keywords of the system, then those of each surface. The
/// diagnostics must outlive it.
class Reader {
 public:
  explicit Reader(Diagnostics& diagnostics) : diagnostics_(diagnostics) {}

  /// Reads a file; lengths of the result are in mm. Nothing if the diagnostics then have an error, also an
  /// earlier one. Call it once per instance.
  [[nodiscard]] std::optional<spec::Lens> read(const std::shared_ptr<const SourceText>& source);

 private:
  using Handler = void (Reader::*)(const Line&);
  static const std::map<std::string, Handler>& system_handlers();
  static const std::map<std::string, Handler>& surface_handlers();

  void read_line(const Line& line);
  void report_unknown(const Line& line);

  void mode(const Line& line);
  void name(const Line& line);
  void unit(const Line& line);
  void require_first_aperture(const Line& line);
  void pupil(const Line& line);
  void f_number(const Line& line);
  void open_by_stop(const Line& line);
  void environment(const Line& line);
  void catalogues(const Line& line);
  void field_type(const Line& line);
  void require_plain_spaces(const Line& line);
  void x_fields(const Line& line);
  void y_fields(const Line& line);
  void wavelength(const Line& line);
  void primary(const Line& line);
  void vignetting(const Line& line);
  void configurations(const Line& line);

  void surface(const Line& line);
  void type(const Line& line);
  void curvature(const Line& line);
  void thickness(const Line& line);
  void glass(const Line& line);
  void conic(const Line& line);
  void parameter(const Line& line);
  void stop(const Line& line);
  void diameter(const Line& line);
  void clear_aperture(const Line& line);
  void floating_aperture(const Line&) { current().fixed = true; }
  void coating(const Line& line);

  ReadSurface& current() { return surfaces_.back(); }
  [[nodiscard]] bool is_object() const { return surfaces_.size() == 1; }
  void error(const Line& line, std::size_t word, std::string message) {
    diagnostics_.error(line.where(word), std::move(message), ErrorCode::input);
  }
  spec::LensGlass named_glass(const Line& line) const;
  std::optional<spec::LensGlass> model_glass(const Line& line);
  void require_complete();
  void check_parameters(const ReadSurface& read, bool object);
  void require_angles();
  void finish_fields();
  void finish_wavelengths();
  void report_weights();
  spec::LensSurface finished(const ReadSurface& read) const;

  Diagnostics& diagnostics_;
  spec::Lens lens_{};
  std::vector<ReadSurface> surfaces_{};
  std::vector<std::string> catalogues_{};
  std::vector<double> fields_{};                 // Along y [degrees], or in the file's unit for heights.
  std::map<int, ReadWavelength> wavelengths_{};  // Key: number in the file.
  double unit_mm_ = 1;                           // The file's unit of length [mm].
  int field_kind_ = 0;                           // 0: angles, 1: object heights, 2: paraxial image heights.
  std::size_t field_count_ = 0;                  // 0: as many as the file lists.
  std::size_t wavelength_count_ = 0;             // 0: as many as the file lists.
  SourcePosition wavelength_count_where_{};
  SourcePosition fields_where_{};  // Position of the number of fields.
  std::optional<Line> fields_line_{};
  int primary_ = 1;  // Number of the primary wavelength.
  std::optional<Line> primary_line_{};
  std::string aperture_word_{};  // Keyword of the line that set the aperture.
  bool open_by_stop_ = false;    // True for FLOA: the diameter of the stop is the aperture.
  bool ended_ = false;  // True after the last surface; operands of merit functions and tolerances follow.
};

}  // namespace abbe::description::zemax
