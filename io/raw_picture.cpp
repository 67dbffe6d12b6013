#include "io/raw_picture.h"

#include "io/atomic_file.h"
#include "io/error.h"
#include "io/picture_codec.h"
#include "io/text.h"

namespace abbe {

void write_dng(const std::filesystem::path& path, const RawPicture& raw) {
  const bool mosaic = raw.mosaic_width > 0;
  if (raw.channels.size() != 3 && (mosaic || raw.planes.size() != 1))
    throw Error(ErrorCode::output, path.string(),
                "a DNG stores one plane, three planes or a mosaic of three channels (got " +
                    std::to_string(raw.channels.size()) + " channels; .tif and .fits store any number)");
  write_atomically(path, picture_codec().encode_dng(path.string(), raw));
}

void write_fits(const std::filesystem::path& path, const RawPicture& raw) {
  write_atomically(path, picture_codec().encode_fits(path.string(), raw));
}

bool is_raw_picture(const std::filesystem::path& path) {
  const std::string extension = extension_of(path);
  return extension == ".dng" || extension == ".fits" || extension == ".fit";
}

RawPicture read_raw_picture(const std::filesystem::path& path) {
  require_file(path);
  return extension_of(path) == ".dng" ? picture_codec().read_dng(path.string())
                                      : picture_codec().read_fits(path.string());
}

}  // namespace abbe
