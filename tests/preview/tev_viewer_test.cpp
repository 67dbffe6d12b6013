#include "preview/tev_viewer.h"

#include <gtest/gtest.h>

#include <atomic>

#include "results/rendered_film.h"
#include "tests/preview/rendered_cornell.h"
#include "tests/preview/tev_listener.h"

namespace abbe {
namespace {

using test::TevListener;

test::RenderedScene of_resolution(const std::string& resolution) {
  return test::rendered_cornell(
      {{"/sensor/resolution", resolution}, {"/sensor/pixel_pitch_um", "30"}, {"/render/samples", "2"}});
}

TEST(TevViewer, IsSentTheFilm) {
  const test::RenderedScene made = of_resolution("[700, 401]");  // of more rows than one packet takes
  TevListener viewer;
  {
    TevViewer sender(made.scene, made.part.identity, viewer.address(), 2,
                     [](const std::string& text) { FAIL() << text; });
    EXPECT_TRUE(sender.viewer_is_ready());
    sender.show(made.part.result);
    sender.end(made.part.result);
  }
  viewer.wait();
  EXPECT_EQ(viewer.name.substr(0, 14), "cornell.json (");
  EXPECT_EQ(viewer.width, 700);
  EXPECT_EQ(viewer.height, 401);
  EXPECT_EQ(viewer.updates, 12);  // two packets for each of the channels, twice
  const Image film = film_image(made.part);
  ASSERT_EQ(viewer.channels.size(), 3U);
  for (const auto& [channel, values] : viewer.channels)
    EXPECT_EQ(values, film.find(channel)->values) << channel;
}

TEST(TevViewer, OneThatGoesAwayIsToldOnceAndLeftAlone) {
  const test::RenderedScene made = of_resolution("[700, 401]");
  TevListener viewer(2);
  std::atomic<int> warnings = 0;
  {
    TevViewer sender(made.scene, made.part.identity, viewer.address(), 2,
                     [&](const std::string&) { ++warnings; });
    sender.show(made.part.result);
    viewer.wait();
    for (int i = 0; i < 3; ++i) sender.end(made.part.result);
    EXPECT_FALSE(sender.viewer_is_ready());
  }
  EXPECT_EQ(warnings, 1);
}

TEST(TevViewer, WhereNoneListensThereIsAnError) {
  const test::RenderedScene made = of_resolution("[4, 4]");
  int port = 0;
  {
    TevListener viewer(0);
    port = viewer.address().port;
    const TevViewer sender(made.scene, made.part.identity, viewer.address(), 1, [](const std::string&) {});
  }
  for (const char* host : {"127.0.0.1", "::1"}) {
    try {
      const TevViewer sender(made.scene, made.part.identity, {host, port}, 1, [](const std::string&) {});
      FAIL() << "a viewer was found";
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ErrorCode::output);
      EXPECT_EQ(std::string(error.what()), (std::string(host) == "::1" ? "[::1]" : host) +
                                               (":" + std::to_string(port)) + ": no viewer listens there");
    }
  }
}

}  // namespace
}  // namespace abbe
