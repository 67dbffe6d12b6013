#include "cli/compare.h"

#include "cli/answer.h"
#include "io/exr.h"
#include "validation/statistics/image_difference.h"

namespace abbe::cli {

int compare(const CompareOptions& options) {
  const Image image = read_exr(options.image);
  const Comparison c = compare_images(image, read_exr(options.reference));
  Json answer;
  answer["relMSE"] = c.rel_mse;
  answer["rmse"] = c.rmse;
  answer["mean_ratio"] = c.mean_ratio;
  answer["dE00_mean"] = c.color ? Json(c.color->mean) : Json();
  answer["dE00_p95"] = c.color ? Json(c.color->p95) : Json();
  answer["dE00_max"] = c.color ? Json(c.color->max) : Json();
  print(answer, options.json);
  return 0;
}

}  // namespace abbe::cli
