// The module that finds charts by OpenCV's detector of ColorCheckers.
#include <cmath>

#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/mcc.hpp>

#include "develop/chart_finder.h"

namespace {

using abbe::ByteImage;
using abbe::FoundChart;

// The chart as OpenCV's model has it: cells of 2.75 units, of which patches take 2.5 in the middle, within a
// frame of an eighth.
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

cv::Point2f middle_of_cell(int column, int row) {
  return {kFrame + (static_cast<float>(column) + 0.5F) * kCell,
          kFrame + (static_cast<float>(row) + 0.5F) * kCell};
}

// Middles of patches, as the model and a picture have them.
struct Middles {
  std::vector<cv::Point2f> in_model;
  std::vector<cv::Point2f> in_picture;
};

// Each patch is what looks like its middle and hangs together with it, in a picture that shows the chart
// straight. What runs into the frame, as black does, or is a part of a patch tells nothing.
Middles middles_of_patches(const cv::Mat& image, const cv::Mat& to_picture) {
  constexpr float kScale = 24;  // pixels per unit
  constexpr int kMargin = 24;   // pixels around the chart
  constexpr double kAlike = 24;
  const cv::Mat to_straight = (cv::Mat_<double>(3, 3) << kScale, 0, kMargin, 0, kScale, kMargin, 0, 0, 1);
  const cv::Mat to_model = to_straight.inv();
  const cv::Size size(static_cast<int>(kScale * (kColumns * kCell + 2 * kFrame)) + 2 * kMargin,
                      static_cast<int>(kScale * (kRows * kCell + 2 * kFrame)) + 2 * kMargin);
  cv::Mat straight;
  cv::warpPerspective(image, straight, to_picture * to_model, size, cv::INTER_LINEAR | cv::WARP_INVERSE_MAP);
  cv::medianBlur(straight, straight, 5);
  Middles middles;
  for (int row = 0; row < kRows; ++row)
    for (int column = 0; column < kColumns; ++column) {
      const cv::Point2f expected = middle_of_cell(column, row);
      const cv::Point seed(expected * kScale + cv::Point2f(kMargin, kMargin));
      cv::Mat alike = cv::Mat::zeros(size.height + 2, size.width + 2, CV_8UC1);
      cv::floodFill(straight, alike, seed, {}, nullptr, cv::Scalar::all(kAlike), cv::Scalar::all(kAlike),
                    4 | cv::FLOODFILL_FIXED_RANGE | cv::FLOODFILL_MASK_ONLY);
      const cv::Moments moments =
          cv::moments(alike(cv::Rect(cv::Point(1, 1), size)), true);  // without its border
      const double area = moments.m00 / std::pow(static_cast<double>(kScale * kPatch), 2);
      if (area < 0.8 || area > 1.2) continue;
      middles.in_model.push_back(expected);
      const cv::Point2d found(moments.m10 / moments.m00, moments.m01 / moments.m00);
      middles.in_picture.emplace_back((found - cv::Point2d(kMargin, kMargin)) / static_cast<double>(kScale));
    }
  if (!middles.in_picture.empty())
    cv::perspectiveTransform(middles.in_picture, middles.in_picture, to_picture);
  return middles;
}

// OpenCV's detector is a few pixels from the truth; the middles of patches are much nearer.
cv::Mat refined(const cv::Mat& image, const cv::Mat& to_picture) {
  constexpr std::size_t kEnough = 8;
  constexpr double kOutlier = 3;  // pixels
  const Middles middles = middles_of_patches(image, to_picture);
  if (middles.in_model.size() < kEnough) return to_picture;
  const cv::Mat fitted = cv::findHomography(middles.in_model, middles.in_picture, cv::RANSAC, kOutlier);
  return fitted.empty() ? to_picture : fitted;
}

cv::Mat mat_of(const ByteImage& picture) {
  cv::Mat image(picture.height, picture.width, CV_8UC3);
  auto pixel = picture.pixels.begin();
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x, ++pixel)
      image.at<cv::Vec3b>(y, x) = {(*pixel)[2], (*pixel)[1], (*pixel)[0]};
  return image;
}

std::optional<FoundChart> find(const ByteImage& picture) {
  // Threads of its own fill its tables at once, and lose some.
  cv::setNumThreads(1);
  const cv::Mat image = mat_of(picture);
  const auto detector = cv::mcc::CCheckerDetector::create();
  if (!detector->process(image, cv::mcc::MCC24, 1)) return std::nullopt;
  const cv::Ptr<cv::mcc::CChecker> found = detector->getBestColorChecker();
  const cv::Mat to_picture = refined(image, cv::getPerspectiveTransform(whole_chart(), found->getBox()));
  std::vector<cv::Point2f> corners;
  cv::perspectiveTransform(rectangle(kFrame, kFrame, kColumns * kCell, kRows * kCell), corners, to_picture);
  FoundChart chart{{}, static_cast<double>(found->getCost())};
  // OpenCV counts from the middle of the first pixel, we from its corner.
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
