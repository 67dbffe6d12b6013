// The chart detector module, by OpenCV's detector of ColorCheckers.
#include <algorithm>
#include <cmath>

#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/mcc.hpp>

#include "develop/find_chart.h"

namespace {

using abbe::ByteImage;
using abbe::FoundChart;

// The chart in OpenCV's model: cells of 2.75 units with patches of 2.5 units in their centers, and a frame of
// an eighth.
constexpr float kCell = 2.75F;
constexpr float kPatch = 2.5F;
constexpr float kFrame = 0.125F;
constexpr int kColumns = 6;
constexpr int kRows = 4;

std::vector<cv::Point2f> rectangle(float left, float top, float width, float height) {
  return {{left, top}, {left + width, top}, {left + width, top + height}, {left, top + height}};
}

std::vector<cv::Point2f> whole_chart() {
  return rectangle(0, 0, kColumns * kCell + 2 * kFrame, kRows * kCell + 2 * kFrame);
}

cv::Point2f center_of_cell(int column, int row) {
  return {kFrame + (static_cast<float>(column) + 0.5F) * kCell,
          kFrame + (static_cast<float>(row) + 0.5F) * kCell};
}

// Centers of patches in the model and in a picture.
struct PatchCenters {
  std::vector<cv::Point2f> in_model;
  std::vector<cv::Point2f> in_picture;
};

// Finds each patch as the connected region of similar colour around its expected center, in a rectified
// picture of the chart. Regions that extend into the frame, as black may, or cover only a part of a patch are
// ignored.
PatchCenters patch_centers(const cv::Mat& image, const cv::Mat& to_picture) {
  constexpr float kScale = 24;  // pixels per unit
  constexpr int kMargin = 24;   // pixels
  constexpr double kColorTolerance = 24;
  const cv::Mat to_straight = (cv::Mat_<double>(3, 3) << kScale, 0, kMargin, 0, kScale, kMargin, 0, 0, 1);
  const cv::Mat to_model = to_straight.inv();
  const cv::Size size(static_cast<int>(kScale * (kColumns * kCell + 2 * kFrame)) + 2 * kMargin,
                      static_cast<int>(kScale * (kRows * kCell + 2 * kFrame)) + 2 * kMargin);
  cv::Mat straight;
  cv::warpPerspective(image, straight, to_picture * to_model, size, cv::INTER_LINEAR | cv::WARP_INVERSE_MAP);
  cv::medianBlur(straight, straight, 5);
  PatchCenters centers;
  for (int row = 0; row < kRows; ++row)
    for (int column = 0; column < kColumns; ++column) {
      const cv::Point2f expected = center_of_cell(column, row);
      const cv::Point seed(expected * kScale + cv::Point2f(kMargin, kMargin));
      cv::Mat mask = cv::Mat::zeros(size.height + 2, size.width + 2, CV_8UC1);
      cv::floodFill(straight, mask, seed, {}, nullptr, cv::Scalar::all(kColorTolerance),
                    cv::Scalar::all(kColorTolerance),
                    4 | cv::FLOODFILL_FIXED_RANGE | cv::FLOODFILL_MASK_ONLY);
      const cv::Moments moments =
          cv::moments(mask(cv::Rect(cv::Point(1, 1), size)), true);  // without its border
      const double area = moments.m00 / std::pow(static_cast<double>(kScale * kPatch), 2);
      if (area < 0.8 || area > 1.2) continue;
      centers.in_model.push_back(expected);
      const cv::Point2d found(moments.m10 / moments.m00, moments.m01 / moments.m00);
      centers.in_picture.emplace_back((found - cv::Point2d(kMargin, kMargin)) / static_cast<double>(kScale));
    }
  if (!centers.in_picture.empty())
    cv::perspectiveTransform(centers.in_picture, centers.in_picture, to_picture);
  return centers;
}

// OpenCV's detector is a few pixels off; the centers of patches are much more accurate.
cv::Mat refined(const cv::Mat& image, const cv::Mat& to_picture) {
  constexpr std::size_t kEnough = 8;
  constexpr double kOutlier = 3;  // pixels
  const PatchCenters centers = patch_centers(image, to_picture);
  if (centers.in_model.size() < kEnough) return to_picture;
  const cv::Mat fitted = cv::findHomography(centers.in_model, centers.in_picture, cv::RANSAC, kOutlier);
  return fitted.empty() ? to_picture : fitted;
}

// The picture as OpenCV has it: blue, green, red.
cv::Mat mat_of(const ByteImage& picture) {
  cv::Mat image(picture.height, picture.width, CV_8UC3);
  std::ranges::transform(picture.pixels, image.begin<cv::Vec3b>(),
                         [](const auto& rgb) { return cv::Vec3b(rgb[2], rgb[1], rgb[0]); });
  return image;
}

std::optional<FoundChart> find(const ByteImage& picture) {
  // OpenCV's threads fill its tables concurrently and lose entries.
  cv::setNumThreads(1);
  const cv::Mat image = mat_of(picture);
  const auto detector = cv::mcc::CCheckerDetector::create();
  if (!detector->process(image, cv::mcc::MCC24, 1)) return std::nullopt;
  const cv::Ptr<cv::mcc::CChecker> found = detector->getBestColorChecker();
  const cv::Mat to_picture = refined(image, cv::getPerspectiveTransform(whole_chart(), found->getBox()));
  std::vector<cv::Point2f> corners;
  cv::perspectiveTransform(rectangle(kFrame, kFrame, kColumns * kCell, kRows * kCell), corners, to_picture);
  FoundChart chart{{}, static_cast<double>(found->getCost())};
  // OpenCV measures from the center of the first pixel, Abbe from its corner.
  for (std::size_t i = 0; i < 4; ++i)
    chart.corners.at(i) =
        Imath::V2d(static_cast<double>(corners[i].x) + 0.5, static_cast<double>(corners[i].y) + 0.5);
  return chart;
}

}  // namespace

extern "C" __attribute__((visibility("default"))) const abbe::ChartFinder* abbe_chart_finder() {
  static const abbe::ChartFinder kFinder{find};
  return &kFinder;
}
