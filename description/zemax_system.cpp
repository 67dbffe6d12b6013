#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "description/zemax_reader.h"
#include "io/text.h"

// Reads the part of a `.zmx` file before its surfaces.
namespace abbe::description::zemax {

const std::map<std::string, Reader::Handler>& Reader::system_handlers() {
  static const std::map<std::string, Handler> kWords{
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

void Reader::mode(const Line& line) {
  if (line.text(1) != "SEQ")
    error(line, 1,
          fmt::format("only sequential lenses are supported (got mode {}, allowed SEQ)",
                      line.text(1).value_or("")));
}

void Reader::name(const Line& line) {
  for (std::size_t i = 1; i < line.words.size(); ++i) lens_.title += (i > 1 ? " " : "") + line.words[i].text;
}

void Reader::unit(const Line& line) {
  static const std::map<std::string, double> kUnits{{"MM", 1}, {"CM", 10}, {"IN", 25.4}, {"METER", 1000}};
  const auto found = kUnits.find(line.text(1).value_or(""));
  if (found == kUnits.end())
    error(line, 1,
          fmt::format("unknown unit (got {}, allowed MM, CM, IN, METER)", line.text(1).value_or("nothing")));
  else
    unit_mm_ = found->second;
}

void Reader::require_first_aperture(const Line& line) {
  if (!aperture_word_.empty())
    error(line, 0,
          fmt::format("a second aperture (got {} and {}, allowed one of ENPD, FNUM, FLOA)", aperture_word_,
                      line.keyword()));
  aperture_word_ = line.keyword();
}

void Reader::pupil(const Line& line) {
  require_first_aperture(line);
  if (const auto value = line.positive(1, diagnostics_)) lens_.aperture = spec::PupilDiameter{{*value}};
}

void Reader::open_by_stop(const Line& line) {
  require_first_aperture(line);
  open_by_stop_ = true;
}

void Reader::f_number(const Line& line) {
  require_first_aperture(line);
  if (const auto value = line.positive(1, diagnostics_)) lens_.aperture = spec::FNumber{{*value}};
  if (line.text(2).value_or("0") != "0")
    error(line, 2, "an f-number of an object at a finite distance is not supported: use ENPD or FLOA");
}

// Glass catalogues give indices at 20 C and 1 atmosphere.
void Reader::environment(const Line& line) {
  const std::vector<double> values = line.numbers(1);
  if (values.size() >= 2 && (values[0] != 20 || values[1] != 1))
    diagnostics_.warning(
        line.where(1), "refractive indices at 20 C and 1 atm are used, whatever the environment of the lens");
}

void Reader::catalogues(const Line& line) {
  for (std::size_t i = 1; i < line.words.size(); ++i) catalogues_.push_back(lower_case(line.words[i].text));
}

void Reader::field_type(const Line& line) {
  const std::vector<double> values = line.numbers(1);
  if (values.empty() || !(values[0] >= 0 && values[0] <= 2))
    return error(line, 1,
                 fmt::format("fields of this kind are not supported (got {}, allowed 0 angles, 1 object "
                             "heights, 2 paraxial image heights)",
                             line.text(1).value_or("nothing")));
  field_kind_ = static_cast<int>(values[0]);
  const auto count = [&](std::size_t i) {
    return values.size() > i && values[i] > 0 && values[i] < 1000 ? static_cast<std::size_t>(values[i]) : 0;
  };
  field_count_ = count(2);
  wavelength_count_ = count(3);
  fields_where_ = line.where(3);
  wavelength_count_where_ = line.where(4);
  require_plain_spaces(line);
}

// The second number of FTYP declares a telecentric object space, the seventh an afocal image space.
void Reader::require_plain_spaces(const Line& line) {
  for (const auto& [word, space] :
       {std::pair(2, "a telecentric object space"), std::pair(7, "an afocal image space")}) {
    const auto at = static_cast<std::size_t>(word);
    const std::string given = line.text(at).value_or("0");
    if (parse_number(given) != 0)
      error(line, at, fmt::format("{} is not supported (got {}, allowed 0)", space, given));
  }
}

void Reader::x_fields(const Line& line) {
  const std::vector<double> values = line.numbers(1);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (values[i] != 0)
      return error(line, i + 1,
                   fmt::format("only fields along y are supported (got x {:g}, allowed 0)", values[i]));
}

void Reader::y_fields(const Line& line) {
  fields_ = line.numbers(1);
  fields_line_ = line;
}

void Reader::wavelength(const Line& line) {
  const auto number = line.positive(1, diagnostics_);
  const auto um = line.number(2, diagnostics_);
  if (!number || !um) return;
  if (!spec::kWavelength.contains(*um * 1000)) {
    // Zemax writes unused wavelengths too.
    if (wavelength_count_ == 0 || *number <= static_cast<double>(wavelength_count_))
      error(line, 2,
            fmt::format("wavelength out of range (got {} nm, allowed {} nm)", *um * 1000,
                        spec::kWavelength.text()));
    return;
  }
  const auto weight = line.text(3) ? line.number(3, diagnostics_) : 1;
  if (weight) wavelengths_[static_cast<int>(*number)] = {*um * 1000, *weight, line.where(3)};
}

void Reader::primary(const Line& line) {
  if (const auto number = line.positive(1, diagnostics_)) {
    primary_ = static_cast<int>(*number);
    primary_line_ = line;
  }
}

void Reader::vignetting(const Line& line) {
  const std::vector<double> values = line.numbers(1);
  const auto used = std::find_if(values.begin(), values.end(), [](double v) { return v != 0; });
  if (used != values.end())
    diagnostics_.warning(
        line.where(1), fmt::format("the vignetting factors of {} are ignored: only clear apertures vignette",
                                   line.keyword()));
}

void Reader::configurations(const Line& line) {
  if (line.numbers(1).size() > 0 && line.numbers(1)[0] > 1)
    error(line, 1,
          fmt::format("lenses of several configurations are not supported (got {:g})", line.numbers(1)[0]));
}

void Reader::require_angles() {
  for (std::size_t i = 0; i < fields_.size(); ++i)
    if (!spec::kFieldAngle.contains(fields_[i]))
      error(*fields_line_, i + 1,
            fmt::format("field out of range (got {} degrees, allowed {} degrees)", fields_[i],
                        spec::kFieldAngle.text()));
}

void Reader::finish_fields() {
  // A single field on the axis needs no YFLN.
  if (std::max<std::size_t>(fields_.size(), 1) < field_count_)
    diagnostics_.error(fields_line_ ? fields_line_->where() : fields_where_,
                       fmt::format("fewer fields along y than FTYP declares (got {}, expected {})",
                                   fields_.size(), field_count_),
                       ErrorCode::input);
  if (field_count_ > 0) fields_.resize(field_count_);
  if (field_kind_ != 0)
    for (double& field : fields_) field *= unit_mm_;
  if (field_kind_ == 0) require_angles();
  if (field_kind_ == 0)
    lens_.fields = spec::FieldAngles{{fields_}};
  else if (field_kind_ == 1)
    lens_.fields = spec::ObjectHeights{{fields_}};
  else
    lens_.fields = spec::ImageHeights{{fields_}};
}

// Warns of different weights of wavelengths; equal weights have no effect.
void Reader::report_weights() {
  const auto other = std::find_if(wavelengths_.begin(), wavelengths_.end(), [&](const auto& wavelength) {
    return wavelength.second.weight != wavelengths_.begin()->second.weight;
  });
  if (other != wavelengths_.end())
    diagnostics_.warning(other->second.weight_where,
                         "the weights of WAVM are ignored: all wavelengths have equal weights");
}

void Reader::finish_wavelengths() {
  if (wavelength_count_ > 0)
    wavelengths_.erase(wavelengths_.upper_bound(static_cast<int>(wavelength_count_)), wavelengths_.end());
  report_weights();
  std::vector<int> numbers;
  std::vector<double> used_nm;
  for (const auto& [number, wavelength] : wavelengths_) {
    numbers.push_back(number);
    used_nm.push_back(wavelength.nm);
    if (number == primary_)
      lens_.primary_nm = {{wavelength.nm}, primary_line_ ? primary_line_->where(1) : lens_.where};
  }
  if (primary_line_ && !lens_.primary_nm)
    error(*primary_line_, 1,
          fmt::format("no wavelength of the file has this number (got {}, allowed {})", primary_,
                      numbers.empty() ? "none without WAVM" : fmt::format("{}", fmt::join(numbers, ", "))));
  if (used_nm.size() < wavelength_count_)
    diagnostics_.error(wavelength_count_where_,
                       fmt::format("fewer wavelengths (WAVM) than FTYP declares (got {}, expected {})",
                                   used_nm.size(), wavelength_count_),
                       ErrorCode::input);
  if (!used_nm.empty()) lens_.wavelengths_nm = std::move(used_nm);
}

}  // namespace abbe::description::zemax
