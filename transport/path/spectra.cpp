#include "transport/path/spectra.h"

namespace abbe {

void SharedSpectra::begin(const SampledWavelengths& wavelengths) {
  wavelengths_ = wavelengths;
  ++packet_;
  if (packet_ != 0) return;
  bsdfs_ = {};  // after 2^32 packets what was kept in the first would seem new
  emissions_ = {};
  channel_shares_ = {};
  packet_ = 1;
}

void SharedSpectra::look_up(std::uint32_t material, Kept<Bsdf>& kept) const {
  kept = {material, packet_, make_bsdf(scene_.materials[material], {wavelengths_.lambda_nm})};
}

}  // namespace abbe
