#include "preview/preview.h"

#include <charconv>
#include <cmath>
#include <thread>
#include <utility>

#include <nlohmann/json.hpp>

#include "io/text.h"
#include "page_text.h"
#include "preview/viewer_film.h"

namespace abbe {
namespace {

using Json = nlohmann::ordered_json;

// The page requests the state twice a second.
constexpr std::chrono::seconds kWatchedFor{3};
constexpr std::chrono::seconds kLingers{2};
constexpr double kMaxEncodingFraction = 0.01;
constexpr std::chrono::milliseconds kMinPause{200};
constexpr double kMaxStops = 30;

// File names may contain any bytes: those that are not UTF-8 become U+FFFD.
PageAnswer json_page(const Json& json) {
  return {200, "application/json",
          std::make_shared<const std::string>(json.dump(-1, ' ', false, Json::error_handler_t::replace))};
}

// Unknown values become null.
Json number_or_null(double x) {
  return std::isfinite(x) ? Json(x) : Json();
}

Json error_json(const RelativeError& error) {
  return {{"median", number_or_null(error.median)},
          {"p95", number_or_null(error.p95)},
          {"frame_mean", number_or_null(error.frame_mean)}};
}

std::string parameter(const PageRequest& request, const std::string& key) {
  const auto found = request.parameters.find(key);
  return found == request.parameters.end() ? "" : found->second;
}

std::optional<int> whole_number(const std::string& text) {
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(number) : std::nullopt;
}

}  // namespace

Preview::Preview(const Scene& scene, FilmIdentity identity, const ViewOptions& view,
                 const ServerAddress& address, int threads)
    : scene_(scene),
      identity_(std::move(identity)),
      threads_(threads),
      film_(scene, view),
      server_(address, [this](const PageRequest& request) { return answer(request); }) {}

bool Preview::is_watched() const {
  return Clock::now() - kWatchedFor < last_request_.load();
}

bool Preview::viewer_is_ready() {
  if (!is_watched()) return false;
  cost_s_ += film_.take_time_spent();
  const std::chrono::duration<double> pause(cost_s_ / threads_ / kMaxEncodingFraction);
  return Clock::now() - last_snapshot_ > std::max<std::chrono::duration<double>>(pause, kMinPause);
}

void Preview::show(const RenderResult& result) {
  const Clock::time_point begin = Clock::now();
  film_.replace(take_snapshot(scene_, identity_, result, threads_));
  last_snapshot_ = Clock::now();
  cost_s_ = std::chrono::duration<double>(last_snapshot_ - begin).count() * threads_;
}

void Preview::set_progress(const Progress& progress) {
  const std::scoped_lock lock(progress_mutex_);
  progress_ = progress;
}

void Preview::end(const RenderResult& result) {
  if (!is_watched()) return;
  show(result);
  ended_ = true;
  std::this_thread::sleep_for(kLingers);
}

PageAnswer Preview::answer(const PageRequest& request) {
  if (request.path == "/") return {200, "text/html", std::make_shared<const std::string>(kPreviewPage)};
  last_request_ = Clock::now();
  if (request.path == "/state") return state();
  if (request.path == "/picture.png") return picture(request);
  if (request.path == "/pixel") return pixel(request);
  return not_found();
}

PageAnswer Preview::state() const {
  Progress progress{};
  {
    const std::scoped_lock lock(progress_mutex_);
    progress = progress_;
  }
  const bool ended = ended_;
  return json_page({{"scene", identity_.at("scene")},
                    {"ended", ended},
                    {"share", progress.fraction_done},
                    {"samples_per_pixel", progress.samples},
                    {"samples_per_s", progress.rate},
                    {"elapsed_s", progress.elapsed_s},
                    {"left_s", ended ? Json(0) : number_or_null(progress.left_s)},
                    {"relative_error", error_json(progress.error)},
                    {"error_samples_per_pixel", progress.error_samples},
                    {"picture", film_.number()},
                    {"picture_samples_per_pixel", film_.samples()},
                    {"width", scene_.camera.width},
                    {"height", scene_.camera.height},
                    {"views", film_.views()}});
}

PageAnswer Preview::picture(const PageRequest& request) {
  const std::string view = parameter(request, "view");
  const std::string exposure = parameter(request, "exposure");
  const std::optional<double> stops = exposure.empty() ? 0 : parse_number(exposure);
  if (!stops || !(std::abs(*stops) <= kMaxStops)) return not_found();
  auto png = film_.picture(view.empty() ? film_.views().front() : view, *stops);
  return png ? PageAnswer{200, "image/png", std::move(png)} : not_found();
}

PageAnswer Preview::pixel(const PageRequest& request) {
  const std::optional<int> x = whole_number(parameter(request, "x"));
  const std::optional<int> y = whole_number(parameter(request, "y"));
  const auto pixel = x && y ? film_.pixel(*x, *y) : std::nullopt;
  if (!pixel) return not_found();
  Json values = Json::array();
  for (const ViewerFilm::Pixel::Value& value : pixel->values) {
    values.push_back({{"channel", value.channel}, {"value", value.value}});
    if (value.wavelength_nm) values.back()["wavelength_nm"] = *value.wavelength_nm;
  }
  return json_page({{"x", *x}, {"y", *y}, {"samples_per_pixel", pixel->samples}, {"values", values}});
}

}  // namespace abbe
