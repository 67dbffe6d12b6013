#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "description/lens.h"
#include "description/lens_files.h"
#include "io/text.h"
#include "materials/index/library.h"

namespace abbe::description {
namespace zemax {
namespace {

using lenses::Line;

// Keywords, in upper case, that do not affect what Abbe reads: notes, polarisation, tolerances, weights,
// variables, solves with stored values, display and optimisation settings.
constexpr std::array<std::string_view, 44> kIgnored{
    // Keywords of the system.
    "VERS", "NOTE", "PFIL", "LANG", "GFAC", "RAIM", "PUSH", "SDMA", "OMMA", "ROPD", "HYPR", "PICB", "FWGN",
    "FWGT", "WWGN", "WWGT", "POLS", "GLRS", "GSTD", "NSCD", "COFN", "BLNK", "TOL", "MOFF", "TITL",
    // Keywords of surfaces.
    "COMM", "FIMP", "HIDE", "MIRR", "SLAB", "POPS", "MEMA", "VDSZ", "VCUR", "VCON", "VPAR", "PZUP", "PCUR",
    "PPAR", "PCON", "MAZH", "RSCE", "RSCO", "SCOL"};
// Number of coefficients of an EVENASPH surface: those of r^2, r^4, ... r^16.
constexpr std::size_t kEvenCoefficients = 8;
// Older files have this number for INFINITY; larger ones are infinite too.
constexpr double kInfinity = 1e10;

/// A surface as read so far, with the data that decide the meaning of its lines. Lengths are in the file's
/// unit, also those of `surface`, until `Reader::finished` converts them to mm.
struct ReadSurface {
  spec::LensSurface surface;                     // Without radius, r2 and asphere.
  std::set<std::string> keywords;                // Of its lines.
  double curvature = 0;                          // Reciprocal of the radius [1/unit]; 0 for a plane.
  std::array<double, kEvenCoefficients> even{};  // Element i: coefficient of r^(2i+2) [unit^-(2i+1)].
  double semi_diameter = 0;                      // Half the diameter from DIAM.
  bool fixed = false;        // True if the diameter stops light: set by the user, or of a floating aperture.
  bool at_infinity = false;  // True for an object at infinity.
  bool standard = false;     // True for the type STANDARD, which has no parameters.
  std::optional<Line> parameter{};  // The first parameter that is not 0.
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
  [[nodiscard]] std::optional<spec::Lens> read(const std::shared_ptr<const SourceText>& source) {
    lens_.where = {source, SourcePosition::kWholeFile, ""};
    for (const Line& line : lenses::lines_of(source)) read_line(line);
    if (surfaces_.size() < 3) {
      error(lens_.where,
            "a lens of Zemax has an object, surfaces and an image (got {} SURF, expected 3 or more): is the "
            "file cut short?",
            surfaces_.size());
      return std::nullopt;
    }
    require_complete();
    if (!surfaces_.front().at_infinity)
      lens_.object_distance = surfaces_.front().surface.thickness * unit_mm_;
    for (std::size_t i = 1; i + 1 < surfaces_.size(); ++i) lens_.surfaces.push_back(finished(surfaces_[i]));
    if (auto* pupil = std::get_if<spec::PupilDiameter>(&lens_.aperture)) pupil->value *= unit_mm_;
    finish_fields();
    finish_wavelengths();
    return diagnostics_.has_errors() ? std::nullopt : std::optional(std::move(lens_));
  }

 private:
  using Handlers = std::map<std::string, void (Reader::*)(const Line&)>;

  static const Handlers& system_handlers() {
    static const Handlers kWords{
        {"MODE", &Reader::mode},        {"NAME", &Reader::name},          {"UNIT", &Reader::unit},
        {"ENPD", &Reader::pupil},       {"FNUM", &Reader::f_number},      {"FLOA", &Reader::open_by_stop},
        {"ENVD", &Reader::environment}, {"GCAT", &Reader::catalogues},    {"FTYP", &Reader::field_type},
        {"XFLN", &Reader::x_fields},    {"YFLN", &Reader::y_fields},      {"WAVM", &Reader::wavelength},
        {"PWAV", &Reader::primary},     {"VDXN", &Reader::vignetting},    {"VDYN", &Reader::vignetting},
        {"VCXN", &Reader::vignetting},  {"VCYN", &Reader::vignetting},    {"VANN", &Reader::vignetting},
        {"ZVDX", &Reader::vignetting},  {"ZVDY", &Reader::vignetting},    {"ZVCX", &Reader::vignetting},
        {"ZVCY", &Reader::vignetting},  {"MNUM", &Reader::configurations}};
    return kWords;
  }
  static const Handlers& surface_handlers() {
    static const Handlers kWords{{"TYPE", &Reader::type},           {"CURV", &Reader::curvature},
                                 {"DISZ", &Reader::thickness},      {"GLAS", &Reader::glass},
                                 {"CONI", &Reader::conic},          {"PARM", &Reader::parameter},
                                 {"STOP", &Reader::stop},           {"DIAM", &Reader::diameter},
                                 {"CLAP", &Reader::clear_aperture}, {"FLAP", &Reader::floating_aperture},
                                 {"COAT", &Reader::coating}};
    return kWords;
  }

  template <typename... Args>
  void error(const SourcePosition& where, fmt::format_string<Args...> message, Args&&... args) const {
    diagnostics_.error(where, fmt::format(message, std::forward<Args>(args)...), ErrorCode::input);
  }
  ReadSurface& current() { return surfaces_.back(); }
  [[nodiscard]] bool is_object() const { return surfaces_.size() == 1; }

  void read_line(const Line& line) {
    const Handlers& words = surfaces_.empty() ? system_handlers() : surface_handlers();
    const auto found = words.find(line.keyword());
    ended_ =
        ended_ || (!surfaces_.empty() && !line.indented && found == words.end() && line.keyword() != "SURF");
    if (ended_) {
      if (line.keyword() == "MNUM") configurations(line);
    } else if (line.keyword() == "SURF") {
      surface(line);
    } else if (found != words.end()) {
      if (!surfaces_.empty()) current().keywords.insert(line.keyword());
      (this->*found->second)(line);
    } else if (std::ranges::find(kIgnored, line.keyword()) == kIgnored.end()) {
      std::vector<std::string> known(kIgnored.begin(), kIgnored.end());
      for (const auto& [word, handler] : words) known.push_back(word);
      error(line.where(), "{}", unknown_name("keyword of Zemax", line.keyword(), known));
    }
  }

  // The part of the file before its surfaces.

  void mode(const Line& line) {
    if (line.text(1) != "SEQ")
      error(line.where(1), "only sequential lenses are supported (got mode {}, allowed SEQ)",
            line.text(1).value_or(""));
  }
  void name(const Line& line) {
    for (std::size_t i = 1; i < line.words.size(); ++i)
      lens_.title += (i > 1 ? " " : "") + line.words[i].text;
  }
  void unit(const Line& line) {
    static const std::map<std::string, double> kUnits{{"MM", 1}, {"CM", 10}, {"IN", 25.4}, {"METER", 1000}};
    const auto found = kUnits.find(line.text(1).value_or(""));
    if (found == kUnits.end())
      error(line.where(1), "unknown unit (got {}, allowed MM, CM, IN, METER)",
            line.text(1).value_or("nothing"));
    else
      unit_mm_ = found->second;
  }
  void require_first_aperture(const Line& line) {
    if (!aperture_word_.empty())
      error(line.where(), "a second aperture (got {} and {}, allowed one of ENPD, FNUM, FLOA)",
            aperture_word_, line.keyword());
    aperture_word_ = line.keyword();
  }
  void pupil(const Line& line) {
    require_first_aperture(line);
    if (const auto value = line.positive(1, diagnostics_)) lens_.aperture = spec::PupilDiameter{{*value}};
  }
  void f_number(const Line& line) {
    require_first_aperture(line);
    if (const auto value = line.positive(1, diagnostics_)) lens_.aperture = spec::FNumber{{*value}};
    if (line.text(2).value_or("0") != "0")
      error(line.where(2),
            "an f-number of an object at a finite distance is not supported: use ENPD or FLOA");
  }
  void open_by_stop(const Line& line) {
    require_first_aperture(line);
    open_by_stop_ = true;
  }
  // Glass catalogues give indices at 20 C and 1 atmosphere.
  void environment(const Line& line) {
    const std::vector<double> values = line.numbers(1);
    if (values.size() >= 2 && (values[0] != 20 || values[1] != 1))
      diagnostics_.warning(
          line.where(1),
          "refractive indices at 20 C and 1 atm are used, whatever the environment of the lens");
  }
  void catalogues(const Line& line) {
    for (std::size_t i = 1; i < line.words.size(); ++i) catalogues_.push_back(lower_case(line.words[i].text));
  }
  void field_type(const Line& line) {
    const std::vector<double> values = line.numbers(1);
    if (values.empty() || !(values[0] >= 0 && values[0] <= 2))
      return error(line.where(1),
                   "fields of this kind are not supported (got {}, allowed 0 angles, 1 object heights, 2 "
                   "paraxial image heights)",
                   line.text(1).value_or("nothing"));
    field_kind_ = static_cast<int>(values[0]);
    const auto count = [&](std::size_t i) {
      return values.size() > i && values[i] > 0 && values[i] < 1000 ? static_cast<std::size_t>(values[i]) : 0;
    };
    field_count_ = count(2);
    wavelength_count_ = count(3);
    fields_where_ = line.where(3);
    wavelength_count_where_ = line.where(4);
    const std::pair<std::size_t, const char*> unsupported[]{{2, "a telecentric object space"},
                                                            {7, "an afocal image space"}};
    for (const auto& [word, space] : unsupported)
      if (const std::string given = line.text(word).value_or("0"); parse_number(given) != 0)
        error(line.where(word), "{} is not supported (got {}, allowed 0)", space, given);
  }
  void x_fields(const Line& line) {
    const std::vector<double> values = line.numbers(1);
    for (std::size_t i = 0; i < values.size(); ++i)
      if (values[i] != 0)
        return error(line.where(i + 1), "only fields along y are supported (got x {:g}, allowed 0)",
                     values[i]);
  }
  void y_fields(const Line& line) {
    fields_ = line.numbers(1);
    fields_line_ = line;
  }
  void wavelength(const Line& line) {
    const auto number = line.positive(1, diagnostics_);
    const auto um = line.number(2, diagnostics_);
    if (!number || !um) return;
    if (!spec::kWavelength.contains(*um * 1000)) {
      // Zemax writes unused wavelengths too.
      if (wavelength_count_ == 0 || *number <= static_cast<double>(wavelength_count_))
        error(line.where(2), "wavelength out of range (got {} nm, allowed {} nm)", *um * 1000,
              spec::kWavelength.text());
      return;
    }
    const auto weight = line.text(3) ? line.number(3, diagnostics_) : 1;
    if (weight) wavelengths_[static_cast<int>(*number)] = {*um * 1000, *weight, line.where(3)};
  }
  void primary(const Line& line) {
    if (const auto number = line.positive(1, diagnostics_)) {
      primary_ = static_cast<int>(*number);
      primary_line_ = line;
    }
  }
  void vignetting(const Line& line) {
    if (std::ranges::any_of(line.numbers(1), [](double value) { return value != 0; }))
      diagnostics_.warning(line.where(1),
                           fmt::format("the vignetting factors of {} are ignored: only clear apertures "
                                       "vignette",
                                       line.keyword()));
  }
  void configurations(const Line& line) {
    if (const std::vector<double> count = line.numbers(1); !count.empty() && count[0] > 1)
      error(line.where(1), "lenses of several configurations are not supported (got {:g})", count[0]);
  }

  void finish_fields() {
    // A single field on the axis needs no YFLN.
    if (std::max<std::size_t>(fields_.size(), 1) < field_count_)
      error(fields_line_ ? fields_line_->where() : fields_where_,
            "fewer fields along y than FTYP declares (got {}, expected {})", fields_.size(), field_count_);
    if (field_count_ > 0) fields_.resize(field_count_);
    if (field_kind_ != 0)
      for (double& field : fields_) field *= unit_mm_;
    if (field_kind_ == 1) lens_.fields = spec::ObjectHeights{{fields_}};
    if (field_kind_ == 2) lens_.fields = spec::ImageHeights{{fields_}};
    if (field_kind_ != 0) return;
    for (std::size_t i = 0; i < fields_.size(); ++i)
      if (!spec::kFieldAngle.contains(fields_[i]))
        error(fields_line_->where(i + 1), "field out of range (got {} degrees, allowed {} degrees)",
              fields_[i], spec::kFieldAngle.text());
    lens_.fields = spec::FieldAngles{{fields_}};
  }
  void finish_wavelengths() {
    if (wavelength_count_ > 0)
      wavelengths_.erase(wavelengths_.upper_bound(static_cast<int>(wavelength_count_)), wavelengths_.end());
    const auto other = std::ranges::find_if(wavelengths_, [&](const auto& wavelength) {
      return wavelength.second.weight != wavelengths_.begin()->second.weight;
    });
    if (other != wavelengths_.end())
      diagnostics_.warning(other->second.weight_where,
                           "the weights of WAVM are ignored: all wavelengths have equal weights");
    std::vector<int> numbers;
    std::vector<double> used_nm;
    for (const auto& [number, wavelength] : wavelengths_) {
      numbers.push_back(number);
      used_nm.push_back(wavelength.nm);
      if (number == primary_)
        lens_.primary_nm = {{wavelength.nm}, primary_line_ ? primary_line_->where(1) : lens_.where};
    }
    if (primary_line_ && !lens_.primary_nm)
      error(primary_line_->where(1), "no wavelength of the file has this number (got {}, allowed {})",
            primary_, numbers.empty() ? "none without WAVM" : fmt::format("{}", fmt::join(numbers, ", ")));
    if (used_nm.size() < wavelength_count_)
      error(wavelength_count_where_, "fewer wavelengths (WAVM) than FTYP declares (got {}, expected {})",
            used_nm.size(), wavelength_count_);
    if (!used_nm.empty()) lens_.wavelengths_nm = std::move(used_nm);
  }

  // The surfaces.

  void surface(const Line& line) {
    const auto number = line.number(1, diagnostics_);
    if (number && *number != static_cast<double>(surfaces_.size()))
      error(line.where(1), "surfaces must be numbered in order (got {:g}, expected {})", *number,
            surfaces_.size());
    surfaces_.emplace_back().surface.where = line.where();
  }
  void type(const Line& line) {
    const std::string given = line.text(1).value_or("");
    if (given != "STANDARD" && given != "EVENASPH")
      error(line.where(1), "this type of surface is not supported (got {}, allowed STANDARD, EVENASPH)",
            given);
    current().standard = given == "STANDARD";
  }
  void curvature(const Line& line) {
    const double given = current().curvature = line.number(1, diagnostics_).value_or(0);
    if (is_object() && given != 0)
      error(line.where(1), "a curved object is not supported (got {:g}, allowed 0)", given);
  }
  void thickness(const Line& line) {
    const auto given = line.text(1) == "INFINITY" ? kInfinity : line.number(1, diagnostics_);
    if (!given) return;
    current().at_infinity = *given >= kInfinity;
    if (current().at_infinity) {
      if (!is_object()) error(line.where(1), "only the object can be at infinity");
      return;
    }
    current().surface.thickness = *given;
    if (is_object() && !spec::kPositiveMm.contains(*given * unit_mm_))
      error(line.where(1), "distance of the object out of range (got {:g} mm, allowed {} mm)",
            *given * unit_mm_, spec::kPositiveMm.text());
  }

  // Looks up the glass in the catalogues that the file names, in their order; else in all catalogues, with a
  // warning. Another maker's glass of the same name may differ, and a catalogue of the file may be unknown to
  // Abbe.
  [[nodiscard]] spec::LensGlass named_glass(const Line& line) const {
    std::string name = line.words[1].text;
    const std::vector<std::string> sold = glass_names();
    const auto maker = std::ranges::find_if(catalogues_, [&](const std::string& catalogue) {
      return std::ranges::binary_search(sold, catalogue + "/" + name);
    });
    if (maker != catalogues_.end())
      name = *maker + "/" + name;
    else if (!catalogues_.empty())
      diagnostics_.warning(line.where(1), fmt::format("{} is in none of the file's catalogues known to Abbe "
                                                      "(got GCAT {}): all catalogues are searched",
                                                      name, fmt::join(catalogues_, " ")));
    return {{{spec::Ior{{{name}, line.where(1)}}}, line.where(1)}};
  }
  // A glass of three numbers: an index, an Abbe number (0 without dispersion), and the deviation of the
  // partial dispersion from the normal line.
  std::optional<spec::LensGlass> model_glass(const Line& line) {
    constexpr Range kIndex{1, spec::kModelIndex.high};
    const auto nd = line.number(4, diagnostics_);
    const auto vd = line.number(5, diagnostics_);
    const auto partial = line.text(6) ? line.number(6, diagnostics_) : 0;
    if (!nd || !vd || !partial) return std::nullopt;
    if (!kIndex.contains(*nd))
      error(line.where(4), "index out of range (got {:g}, allowed {})", *nd, kIndex.text());
    if (*vd != 0 && !spec::kAbbeNumber.contains(*vd))
      error(line.where(5), "Abbe number out of range (got {:g}, allowed {} or 0)", *vd,
            spec::kAbbeNumber.text());
    if (*partial != 0)
      error(line.where(6), "a deviating partial dispersion is not supported (got {:g}, allowed 0)", *partial);
    spec::LensGlass glass;
    glass.where = line.where(1);
    if (*vd != 0)
      glass.value = spec::ModelGlass{*nd, *vd};
    else
      glass.value = spec::Ior{{{*nd}, line.where(4)}};
    return glass;
  }
  void glass(const Line& line) {
    const std::string given = line.text(1).value_or("");
    if (given == "MIRROR") return error(line.where(1), "mirrors are not supported, only refracting lenses");
    if (given.empty()) return error(line.where(), "GLAS needs the name of a glass");
    if (is_object())
      return error(line.where(1), "an object in glass is not supported (got {}, allowed air)", given);
    current().surface.glass = given == "___BLANK" ? model_glass(line) : named_glass(line);
  }
  void conic(const Line& line) { current().surface.conic = line.number(1, diagnostics_).value_or(0); }
  void parameter(const Line& line) {
    const auto number = line.number(1, diagnostics_);
    const auto value = line.number(2, diagnostics_);
    if (!number || !value || *value == 0) return;
    if (!current().parameter) current().parameter = line;
    if (*number >= 1 && *number <= static_cast<double>(kEvenCoefficients))
      current().even[static_cast<std::size_t>(*number) - 1] = *value;
    else
      error(line.where(1), "unknown parameter (got {:g}, allowed 1 to {})", *number, kEvenCoefficients);
  }
  void stop(const Line& line) {
    if (is_object()) error(line.where(), "the object cannot be the stop");
    current().surface.stop = true;
  }
  // The second number distinguishes a diameter that the user has set from one that Zemax has calculated.
  void diameter(const Line& line) {
    current().semi_diameter = line.number(1, diagnostics_).value_or(0);
    if (line.text(2) == "1") current().fixed = true;
  }
  void clear_aperture(const Line& line) {
    const auto inner = line.number(1, diagnostics_);
    const auto outer = line.positive(2, diagnostics_);
    if (inner && *inner != 0) error(line.where(1), "apertures with a hole are not supported");
    if (outer) current().surface.aperture = *outer;
  }
  void floating_aperture(const Line&) { current().fixed = true; }
  void coating(const Line& line) {
    diagnostics_.warning(line.where(1),
                         fmt::format("the coating {} is ignored, because its layers are in another file",
                                     line.text(1).value_or("")));
  }

  // Reports parameters that the surface type does not have. Checked at the end, because the type may follow
  // its parameters.
  void check_parameters(const ReadSurface& read, bool object) const {
    if (!read.parameter || !(read.standard || object)) return;
    const SourcePosition where = read.parameter->where(2);
    const std::string given = read.parameter->text(2).value_or("");
    if (read.standard)
      error(where, "a STANDARD surface has no parameters: is it an EVENASPH? (got {}, allowed 0)", given);
    else
      error(where, "a curved object is not supported (got {}, allowed 0)", given);
  }
  // Reports an incomplete file: each surface needs all of its data, and the image must be plane and in air.
  void require_complete() const {
    for (std::size_t i = 0; i < surfaces_.size(); ++i) {
      check_parameters(surfaces_[i], i == 0);
      for (const char* word : {"TYPE", "CURV", "DISZ"})
        if (!surfaces_[i].keywords.contains(word))
          error(surfaces_[i].surface.where, "surface {} has no {}: is the file cut short?", i, word);
    }
    const ReadSurface& image = surfaces_.back();
    if (image.surface.glass || image.curvature != 0 || image.parameter || image.surface.stop)
      error(image.surface.where,
            "the last surface, which is the image, must be plane, in air and not the stop: is the file cut "
            "short?");
  }
  [[nodiscard]] spec::LensSurface finished(const ReadSurface& read) const {
    spec::LensSurface surface = read.surface;
    surface.radius = read.curvature == 0 ? 0 : unit_mm_ / read.curvature;
    surface.thickness *= unit_mm_;
    surface.r2 = read.even[0] / unit_mm_;
    for (std::size_t i = 1; i < read.even.size(); ++i)
      surface.asphere.push_back(read.even[i] / std::pow(unit_mm_, 2.0 * static_cast<double>(i) + 1));
    if (!surface.aperture && (read.fixed || (open_by_stop_ && surface.stop)) && read.semi_diameter > 0)
      surface.aperture = read.semi_diameter;
    if (surface.aperture) *surface.aperture *= unit_mm_;
    return surface;
  }

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

}  // namespace
}  // namespace zemax

std::optional<spec::Lens> read_zemax(const std::filesystem::path& file, Diagnostics& diagnostics) {
  const auto source = read_unicode_text(file, diagnostics);
  return source ? zemax::Reader(diagnostics).read(source) : std::nullopt;
}

}  // namespace abbe::description
