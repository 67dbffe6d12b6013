// The picture module: all uses of OpenImageIO, called through io/picture_codec.h.
#include "io/picture_module.h"

#include <memory>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "io/error.h"
#include "io/exr.h"
#include "io/picture.h"
#include "io/picture_codec.h"

namespace abbe {
namespace {
OIIO::ImageSpec spec_of(const PictureHeader& header, const OIIO::TypeDesc& format) {
  OIIO::ImageSpec spec(static_cast<int>(header.width), static_cast<int>(header.height),
                       static_cast<int>(header.channels.size()), format);
  // The library would take a fourth channel for alpha.
  spec.alpha_channel = -1;
  for (const auto& [key, value] : header.metadata) spec.attribute(key, value);
  return spec;
}

// Encoding of values, as in `kColorSpace`; "" if the file declares none. PNM files never do, whatever the
// library reports.
std::string color_space(const OIIO::ImageSpec& spec, std::string_view format) {
  if (spec.format.is_floating_point()) return kLinear;
  const std::string recorded{spec.get_string_attribute(kColorSpace)};
  if (format == "pnm") return "";
  if (OIIO::Strutil::iequals(recorded, kLinear)) return kLinear;
  const float gamma = spec.get_float_attribute("oiio:Gamma", 0);  // `recorded` has it rounded to two digits.
  return gamma > 0 && recorded.starts_with(kGamma) ? kGamma + OIIO::Strutil::to_string(gamma) : recorded;
}

void set(PictureHeader& header, const char* key, const std::string& text) {
  header.metadata.erase(key);
  if (!text.empty()) header.metadata[key] = text;
}

// The result refers to `spec`.
picture_module::LibraryColors library_colors(const OIIO::ImageSpec& spec, std::string_view format) {
  picture_module::LibraryColors colors{format, spec.format.is_floating_point(), spec.nchannels < 3};
  for (const char* const model : {"tiff:ColorSpace", "jpeg:ColorSpace"})
    colors.model += spec.get_string_attribute(model);
  colors.exif_space = spec.get_int_attribute("Exif:ColorSpace");
  colors.profile_name = spec.get_string_attribute("ICCProfile:profile_description");
  if (const OIIO::ParamValue* profile = spec.find_attribute("ICCProfile"))
    colors.profile = {static_cast<const std::uint8_t*>(profile->data()),
                      static_cast<std::size_t>(profile->datasize())};
  return colors;
}

void set_colors(PictureHeader& header, const OIIO::ImageSpec& spec, std::string_view format,
                const std::string& path) {
  const picture_module::LibraryColors library = library_colors(spec, format);
  const picture_module::DeclaredColors declared = picture_module::declared_colors(path, library);
  set(header, kColorSpace, declared.encoding.empty() ? color_space(spec, format) : declared.encoding);
  set(header, kPrimariesKey, library.is_grey ? "" : declared.primaries);
  set(header, kProfileKey, declared.profile);
}

void set_orientation(PictureHeader& header, int orientation) {
  set(header, kOrientation, orientation > 1 && orientation <= 8 ? std::to_string(orientation) : "");
}

PictureHeader header_of(const OIIO::ImageSpec& spec, std::string_view format, const std::string& path) {
  PictureHeader header{spec.width, spec.height, spec.channelnames, {}};
  for (const OIIO::ParamValue& attribute : spec.extra_attribs)
    if (attribute.type() == OIIO::TypeDesc::STRING)
      header.metadata[attribute.name().string()] = attribute.get_string();
  set_colors(header, spec, format, path);
  set_orientation(header, spec.get_int_attribute(kOrientation, 1));
  return header;
}

// Encodes in memory: on a full disk some of the library's writers report nothing, and one exits.
std::string encode_spec(const std::string& path, const OIIO::ImageSpec& spec, const void* pixels) {
  const auto output = OIIO::ImageOutput::create(path);
  if (!output) throw Error(ErrorCode::output, path, OIIO::geterror());
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  if (!output->set_ioproxy(&memory) || !output->open(path, spec) ||
      !output->write_image(spec.format, pixels) || !output->close())
    throw Error(ErrorCode::output, path, output->geterror());

  OIIO::Filesystem::IOMemReader reader(bytes.data(), bytes.size());
  const auto input = OIIO::ImageInput::open(path, nullptr, &reader);
  if (!input || input->spec().width != spec.width || input->spec().height != spec.height ||
      input->spec().nchannels != spec.nchannels)
    throw Error(ErrorCode::output, path, "the encoded picture does not read back " + OIIO::geterror());
  return {bytes.begin(), bytes.end()};
}

std::string encode(const std::string& path, const PictureHeader& header, const PictureCodes& codes) {
  const OIIO::TypeDesc format = codes.index() == 0 ? OIIO::TypeDesc::UINT8 : OIIO::TypeDesc::UINT16;
  const OIIO::ImageSpec spec = spec_of(header, format);
  return std::visit([&](const auto& values) { return encode_spec(path, spec, values.data()); }, codes);
}

void divide(float* pixels, std::uint64_t count, const std::array<double, 3>& factors) {
  for (std::uint64_t i = 0; i < 3 * count; ++i)
    pixels[i] = static_cast<float>(static_cast<double>(pixels[i]) / factors.at(i % 3));
}

// Opens the file so that colours next to an alpha channel are read as stored.
std::unique_ptr<OIIO::ImageInput> opened(const std::string& path) {
  OIIO::ImageSpec how;
  how.attribute("oiio:UnassociatedAlpha", 1);
  auto input = OIIO::ImageInput::open(path, &how);
  if (!input) throw Error(ErrorCode::input, path, OIIO::geterror());
  return input;
}

void read(const std::string& path, const std::function<float*(const PictureHeader&)>& allocate) {
  constexpr const char* kDamaged = "truncated or corrupt";
  if (picture_module::is_damaged_png(path)) throw Error(ErrorCode::input, path, kDamaged);
  const auto input = opened(path);
  const OIIO::ImageSpec spec = input->spec();
  if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.nchannels < 1)
    throw Error(ErrorCode::input, path, "not a two-dimensional image");
  const std::string_view format = input->format_name();
  PictureHeader header = header_of(spec, format, path);
  picture_module::RadianceHeader radiance;
  if (format == "hdr") {
    radiance = picture_module::radiance_header(path);
    set(header, kPrimariesKey, radiance.primaries);
    set_orientation(header, radiance.orientation);
  }
  float* pixels = allocate(header);
  // The library reports missing strips of a TIFF as an error, but returns invented pixels.
  if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, pixels) || input->has_error())
    throw Error(ErrorCode::input, path, kDamaged);
  if (format == "hdr") divide(pixels, spec.image_pixels(), radiance.factors);
}

}  // namespace
}  // namespace abbe

extern "C" __attribute__((visibility("default"))) const abbe::PictureCodec* abbe_picture_codec() {
  static constexpr abbe::PictureCodec kCodec{abbe::encode,
                                             abbe::read,
                                             abbe::picture_module::encode_dng,
                                             abbe::picture_module::encode_fits,
                                             abbe::picture_module::read_dng,
                                             abbe::picture_module::read_fits};
  return &kCodec;
}
