// Writes DNG files with libtiff.
#include "io/picture_module_dng.h"

#include <algorithm>
#include <cstdarg>
#include <cstring>

#include "io/error.h"
#include "io/image.h"
#include "io/picture_module.h"

namespace abbe::picture_module {
namespace {

constexpr std::array<std::uint8_t, 4> kVersion{1, 4, 0, 0};
constexpr std::array<std::uint8_t, 4> kOldestReader{1, 1, 0, 0};

// A file in memory, for libtiff's client functions.
struct MemoryTiff {
  std::string bytes;
  std::size_t at = 0;
};

MemoryTiff& file_of(thandle_t handle) {
  return *static_cast<MemoryTiff*>(handle);
}
tmsize_t read_some(thandle_t handle, void* to, tmsize_t size) {
  MemoryTiff& file = file_of(handle);
  const std::size_t left = file.bytes.size() - std::min(file.at, file.bytes.size());
  const std::size_t count = std::min(static_cast<std::size_t>(size), left);
  std::memcpy(to, file.bytes.data() + file.at, count);
  file.at += count;
  return static_cast<tmsize_t>(count);
}
tmsize_t write_some(thandle_t handle, void* from, tmsize_t size) {
  MemoryTiff& file = file_of(handle);
  const auto count = static_cast<std::size_t>(size);
  file.bytes.resize(std::max(file.bytes.size(), file.at + count));
  std::memcpy(file.bytes.data() + file.at, from, count);
  file.at += count;
  return size;
}
toff_t seek(thandle_t handle, toff_t offset, int origin) {
  MemoryTiff& file = file_of(handle);
  const std::size_t from = origin == SEEK_CUR ? file.at : origin == SEEK_END ? file.bytes.size() : 0;
  file.at = from + static_cast<std::size_t>(offset);
  return file.at;
}
int close(thandle_t) {
  return 0;
}
toff_t size_of(thandle_t handle) {
  return file_of(handle).bytes.size();
}

// Tags of DNG 1.2 and 1.3 that libtiff does not know and would warn about.
constexpr std::uint32_t kForward1 = 50964;
constexpr std::uint32_t kForward2 = 50965;
TIFFExtendProc previous_extender = nullptr;
void add_dng_tags(TIFF* tiff) {
  static std::array<char, 14> matrix{"ForwardMatrix"};
  static std::array<char, 11> list{"OpcodeList"};
  constexpr short kAny = TIFF_VARIABLE;
  constexpr short kAnyOf32Bits = TIFF_VARIABLE2;
  const auto opcodes = [](std::size_t i) {
    return TIFFFieldInfo{kOpcodeLists.at(i), kAnyOf32Bits, kAnyOf32Bits, TIFF_UNDEFINED, FIELD_CUSTOM, 1, 1,
                         list.data()};
  };
  static const std::array<TIFFFieldInfo, 5> kFields{
      {{kForward1, kAny, kAny, TIFF_SRATIONAL, FIELD_CUSTOM, 1, 1, matrix.data()},
       {kForward2, kAny, kAny, TIFF_SRATIONAL, FIELD_CUSTOM, 1, 1, matrix.data()},
       opcodes(0),
       opcodes(1),
       opcodes(2)}};
  TIFFMergeFieldInfo(tiff, kFields.data(), kFields.size());
  if (previous_extender != nullptr) previous_extender(tiff);
}

int keep_quiet(TIFF*, void*, const char*, const char*, std::va_list) {
  return 1;
}

Tiff open(const std::string& path, MemoryTiff& file, const char* mode) {
  register_dng_tags();
  file.at = 0;
  Tiff tiff(TIFFClientOpenExt(path.c_str(), mode, &file, read_some, write_some, seek, close, size_of, nullptr,
                              nullptr, quiet_tiff().get()),
            TIFFClose);
  if (!tiff) throw Error(ErrorCode::output, path, "libtiff cannot create the file");
  return tiff;
}

/// Sets tags; `ok` becomes false if one fails.
struct Tags {
  TIFF* tiff;
  bool ok = true;

  template <typename... Values>
  void set(std::uint32_t tag, Values... values) {
    ok = TIFFSetField(tiff, tag, values...) == 1 && ok;
  }
  // Sets an array, preceded by its length.
  template <typename T>
  void set_all(std::uint32_t tag, const std::vector<T>& values) {
    set(tag, static_cast<int>(values.size()), values.data());
  }
};

// Writes exposure time, f-number and speed into the Exif folder; returns its offset, or 0.
std::uint64_t write_exif(TIFF* tiff, const RawPicture& raw, bool& ok) {
  std::uint64_t offset = 0;
  const bool has_exif =
      // libtiff rejects an empty folder.
      raw.exposure_s || raw.f_number || raw.iso_speed;
  if (!has_exif || TIFFCreateEXIFDirectory(tiff) != 0) return offset;
  Tags exif{tiff};
  if (raw.exposure_s) exif.set(EXIFTAG_EXPOSURETIME, *raw.exposure_s);
  if (raw.f_number) exif.set(EXIFTAG_FNUMBER, *raw.f_number);
  if (raw.iso_speed)
    exif.set_all(EXIFTAG_ISOSPEEDRATINGS,
                 std::vector{static_cast<std::uint16_t>(std::clamp(*raw.iso_speed + 0.5, 1.0, 65535.0))});
  ok = ok && exif.ok && TIFFWriteCustomDirectory(tiff, &offset) == 1;
  return offset;
}

// Index into the picture's channels for each of the three DNG channels. Readers take DNG channels for red,
// green and blue: channels with these names are sorted into that order, others keep theirs.
using Order = std::array<std::size_t, 3>;
constexpr Order kOwnOrder{0, 1, 2};
Order order_of(const std::vector<std::string>& channels) {
  return rgb_order(channels).value_or(kOwnOrder);
}

// Reorders a list with `each` entries per channel, repeated for each pixel if longer than three channels.
template <typename List>
List ordered(const List& list, const Order& order, std::size_t each = 1) {
  List sorted = list;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::size_t channel = i / each % order.size();
    sorted[i] = list[i - each * channel + each * order[channel]];
  }
  return sorted;
}

RawPicture ordered(RawPicture raw) {
  const Order order = order_of(raw.channels);
  if (order == kOwnOrder) return raw;
  raw.channels = ordered(raw.channels, order);
  if (raw.mosaic_width > 0)
    for (std::uint8_t& channel : raw.mosaic)
      channel = static_cast<std::uint8_t>(std::find(order.begin(), order.end(), channel) - order.begin());
  else
    raw.codes = ordered(raw.codes, order);
  for (RawLight& light : raw.lights) {
    light.color = ordered(light.color, order, 3);  // Rows belong to camera channels.
    light.forward = ordered(light.forward, order);
  }
  if (raw.neutral) raw.neutral = ordered(*raw.neutral, order);
  return raw;
}

// Sets size, storage and mosaic of the picture: one strip without compression.
void set_layout(Tags& tags, const RawPicture& raw) {
  const std::size_t samples = raw.planes.size();
  tags.set(TIFFTAG_SUBFILETYPE, 0);
  tags.set(TIFFTAG_IMAGEWIDTH, static_cast<std::uint32_t>(raw.width));
  tags.set(TIFFTAG_IMAGELENGTH, static_cast<std::uint32_t>(raw.height));
  tags.set(TIFFTAG_BITSPERSAMPLE, 16);
  tags.set(TIFFTAG_SAMPLESPERPIXEL, static_cast<int>(samples));
  tags.set(TIFFTAG_COMPRESSION, COMPRESSION_NONE);
  tags.set(TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  tags.set(TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
  tags.set(TIFFTAG_ROWSPERSTRIP, static_cast<std::uint32_t>(raw.height));
  tags.set(TIFFTAG_PHOTOMETRIC, raw.mosaic_width > 0 ? PHOTOMETRIC_CFA : kLinearRaw);
  if (raw.mosaic_width > 0) {
    const auto width = static_cast<std::uint16_t>(raw.mosaic_width);
    const auto height = static_cast<std::uint16_t>(raw.mosaic.size() / width);
    const std::array<std::uint16_t, 2> repeats{height, width};
    tags.set(TIFFTAG_CFAREPEATPATTERNDIM, repeats.data());
    tags.set_all(TIFFTAG_CFAPATTERN, raw.mosaic);
  }
}

void set_levels(Tags& tags, const RawPicture& raw) {
  const std::size_t samples = raw.planes.size();
  const auto code = static_cast<std::uint32_t>(raw.white_level_dn);
  // Readers apply the black and white level after the linearisation table.
  const std::uint32_t white = raw.linear_codes.empty() ? code : raw.linear_codes[code];
  tags.set_all(TIFFTAG_BLACKLEVEL, std::vector<float>(samples, static_cast<float>(raw.black_level_dn)));
  tags.set_all(TIFFTAG_WHITELEVEL, std::vector<std::uint32_t>(samples, white));
  if (!raw.linear_codes.empty()) tags.set_all(TIFFTAG_LINEARIZATIONTABLE, raw.linear_codes);
}

template <std::size_t N>
std::vector<float> floats(const std::array<double, N>& values) {
  return {values.begin(), values.end()};
}

void set_colors(Tags& tags, const RawPicture& raw) {
  struct LightTags {
    std::uint32_t illuminant, color, forward;
  };
  constexpr std::array<LightTags, 2> kLights{
      {{TIFFTAG_CALIBRATIONILLUMINANT1, TIFFTAG_COLORMATRIX1, kForward1},
       {TIFFTAG_CALIBRATIONILLUMINANT2, TIFFTAG_COLORMATRIX2, kForward2}}};
  for (std::size_t i = 0; i < std::min(raw.lights.size(), kLights.size()); ++i) {
    tags.set(kLights[i].illuminant, raw.lights[i].illuminant);
    tags.set_all(kLights[i].color, floats(raw.lights[i].color));
    tags.set_all(kLights[i].forward, floats(raw.lights[i].forward));
  }
  if (raw.neutral) tags.set_all(TIFFTAG_ASSHOTNEUTRAL, floats(*raw.neutral));
}

// Sets the names of camera and program, and the metadata as lines of the description.
void set_names(Tags& tags, const RawPicture& raw) {
  std::string lines;
  for (const auto& [key, value] : raw.metadata) lines += key + ": " + value + "\n";
  const std::string model = raw.camera.empty() ? "Abbe sensor" : raw.camera;
  tags.set(TIFFTAG_IMAGEDESCRIPTION, lines.c_str());
  tags.set(TIFFTAG_MAKE, "Abbe");
  tags.set(TIFFTAG_MODEL, model.c_str());
  tags.set(TIFFTAG_SOFTWARE, "Abbe");
  tags.set(TIFFTAG_DNGVERSION, kVersion.data());
  tags.set(TIFFTAG_DNGBACKWARDVERSION, kOldestReader.data());
  tags.set(TIFFTAG_UNIQUECAMERAMODEL, model.c_str());
}

bool reads_back(const std::string& path, MemoryTiff& file, const RawPicture& raw) {
  const Tiff tiff = open(path, file, "rmc");  // c: read the strip unchanged.
  std::vector<std::uint16_t> codes(raw.codes.size());
  const auto size = static_cast<tmsize_t>(codes.size() * sizeof(std::uint16_t));
  return TIFFReadEncodedStrip(tiff.get(), 0, codes.data(), size) == size && codes == raw.codes;
}

}  // namespace

void register_dng_tags() {
  static const bool once = (previous_extender = TIFFSetTagExtender(add_dng_tags), true);
  static_cast<void>(once);
}

TiffOptions quiet_tiff() {
  TiffOptions options(TIFFOpenOptionsAlloc(), TIFFOpenOptionsFree);
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), keep_quiet, nullptr);
  TIFFOpenOptionsSetWarningHandlerExtR(options.get(), keep_quiet, nullptr);
  return options;
}

std::string encode_dng(const std::string& path, const RawPicture& picture) {
  const RawPicture raw = ordered(picture);
  MemoryTiff file;
  bool ok = true;
  {
    const Tiff tiff = open(path, file, "wlm");
    const std::uint64_t exif = write_exif(tiff.get(), raw, ok);
    TIFFFreeDirectory(tiff.get());  // Creating another directory does not free it.
    TIFFCreateDirectory(tiff.get());
    Tags tags{tiff.get()};
    set_layout(tags, raw);
    set_levels(tags, raw);
    set_colors(tags, raw);
    set_names(tags, raw);
    if (exif != 0) tags.set(TIFFTAG_EXIFIFD, exif);
    std::vector<std::uint16_t> codes = raw.codes;  // A copy: libtiff may swap its bytes.
    const auto size = static_cast<tmsize_t>(codes.size() * sizeof(std::uint16_t));
    ok = ok && tags.ok && TIFFWriteEncodedStrip(tiff.get(), 0, codes.data(), size) == size &&
         TIFFWriteDirectory(tiff.get()) == 1;
  }
  if (!ok || !reads_back(path, file, raw))
    throw Error(ErrorCode::output, path, "the encoded DNG does not read back");
  return std::move(file.bytes);
}

}  // namespace abbe::picture_module
