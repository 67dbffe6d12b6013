#include <gtest/gtest.h>
#include <httplib.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <thread>

#include "io/exr.h"
#include "tests/cli/program.h"
#include "tests/cli/scenes.h"
#include "tests/preview/tev_listener.h"
#include "tests/tier.h"

// A render whose preview is requested while it runs.

namespace abbe::test {
namespace {

using namespace std::chrono_literals;
using Json = nlohmann::json;
using Clock = std::chrono::steady_clock;

// A render in the background, with requests to its page.
class Watched {
 public:
  explicit Watched(const std::string& options, const std::string& scene = ball()) {
    const std::string err = file("watched.err");
    std::filesystem::remove(err);
    pid_ = shell(ABBE_BINARY " render " + scene + " --quiet --preview 0 " + options + " 2>" + err +
                 " >/dev/null & echo $!")
               .out;
    pid_.pop_back();
    const auto begin = Clock::now();
    for (std::string text; port_ == 0 && Clock::now() - begin < 10s; std::this_thread::sleep_for(5ms)) {
      text = read_file(err);
      const std::size_t at = text.find("127.0.0.1:");
      if (at != std::string::npos && text.find('\n', at) != std::string::npos)
        port_ = std::stoi(text.substr(at + 10));
    }
    EXPECT_GT(port_, 0) << read_file(err);
    client_.emplace("127.0.0.1", port_);
    client_->set_read_timeout(10);
  }
  ~Watched() {
    (void)shell("kill -9 " + pid_);
    wait_for_exit();
  }
  Watched(const Watched&) = delete;
  Watched& operator=(const Watched&) = delete;

  [[nodiscard]] Json json(const std::string& path) {
    const auto answer = client_->Get(path);
    return answer && answer->status == 200 ? Json::parse(answer->body) : Json();
  }
  [[nodiscard]] std::string body(const std::string& path) {
    const auto answer = client_->Get(path);
    return answer && answer->status == 200 ? answer->body : "";
  }
  [[nodiscard]] int status(const std::string& path) {
    const auto answer = client_->Get(path);
    return answer ? answer->status : 0;
  }
  // Waits until the files are written and unlocked, even if nobody has asked for the exit status.
  void wait_for_exit() const { (void)shell("while [ -e /proc/" + pid_ + "/exe ]; do sleep 0.02; done"); }
  // The state, once `wanted` holds for it.
  template <typename Wanted>
  Json wait_for(Wanted wanted) {
    Json state;
    for (const auto begin = Clock::now(); Clock::now() - begin < 20s; std::this_thread::sleep_for(10ms)) {
      state = json("/state");
      if (state.is_null() || wanted(state)) return state;
    }
    ADD_FAILURE() << "waited in vain: " << state;
    return {};
  }
  [[nodiscard]] const std::string& pid() const { return pid_; }
  [[nodiscard]] int port() const { return port_; }

 private:
  std::string pid_;
  int port_ = 0;
  std::optional<httplib::Client> client_;
};

TEST(Preview, ThePictureComesSoonAfterTheFirstPass) {
  Watched render("--time 20s --set /sensor/resolution=[200,150] -o " + file("a.exr"));
  (void)render.wait_for([](const Json& state) { return state["samples_per_pixel"] > 0; });
  const auto begin = Clock::now();
  (void)render.wait_for([](const Json& state) { return state["picture"] > 0; });
  EXPECT_EQ(render.body("/picture.png").substr(1, 3), "PNG");
  EXPECT_LT(Clock::now() - begin, 2s);
  const Json state = render.json("/state");
  EXPECT_EQ(state["scene"], "ball.json");
  EXPECT_EQ(state["width"], 200);
  EXPECT_GE(state["views"].size(), 2U);
  EXPECT_EQ(render.json("/pixel?x=100&y=75")["values"].size(), 3U);
}

// File names in Linux may contain any bytes.
TEST(Preview, ASceneMayHaveANameThatIsNoUtf8) {
  const auto scene = scratch().write("caf\xE9.json", ball_scene());
  Watched render("--time 20s -o " + file("latin1.exr"), scene.string());
  EXPECT_EQ(render.json("/state")["scene"], "caf\xEF\xBF\xBD.json");
}

TEST(Preview, ThereAreNoOtherPages) {
  Watched render("--time 20s -o " + file("paths.exr"));
  (void)render.wait_for([](const Json& state) { return state["picture"] > 0; });
  EXPECT_EQ(render.body("/").substr(0, 15), "<!DOCTYPE html>");
  for (const char* path :
       {"/x", "/../etc/passwd", "/pixel", "/pixel?x=1", "/pixel?x=1&y=99", "/pixel?x=a&y=1",
        "/picture.png?view=x", "/picture.png?exposure=x", "/picture.png?exposure=1e9", "/state/"})
    EXPECT_EQ(render.status(path), 404) << path;
}

TEST(Preview, AtTheEndPixelsAreTheFilms) {
  for (const std::string sensor :
       {R"({"resolution":[24,16],"observer":"1931"})",
        R"({"resolution":[24,16],"exposure_s":0.01,"spectral":{"from_nm":400,"to_nm":700,"step_nm":50}})"}) {
    const std::string path = file("end.exr");
    Watched render("--time 0.3s --set '/sensor=" + sensor + "' -o " + path);
    const Json state = render.wait_for([](const Json& told) { return told["ended"] == true; });
    ASSERT_FALSE(state.is_null()) << "the render said nothing of its end";
    EXPECT_EQ(state["error_samples_per_pixel"], state["samples_per_pixel"]);
    EXPECT_EQ(state["left_s"], 0);
    EXPECT_GT(state["samples_per_s"], 0);
    const Json pixel = render.json("/pixel?x=11&y=8");
    EXPECT_EQ(pixel["samples_per_pixel"], state["samples_per_pixel"]);
    render.wait_for_exit();
    const Image film = read_exr(path);
    EXPECT_EQ(film.metadata.at("samples_per_pixel"), std::to_string(pixel["samples_per_pixel"].get<int>()));
    EXPECT_GE(pixel["values"].size(), 3U);
    for (const Json& value : pixel["values"])
      EXPECT_EQ(value["value"].get<float>(),
                film.find(value["channel"].get<std::string>())->values[8 * 24 + 11])
          << value;
  }
}

TEST(Preview, WatchingChangesNoBit) {
  const std::string options =
      std::string(nightly() ? "--spp 3000" : "--spp 1200") + " --set /sensor/resolution=[48,32] -o ";
  ASSERT_EQ(abbe("render " + ball() + " --quiet " + options + file("alone.exr")).code, 0);
  Watched render(options + file("watched.exr"));
  int pictures = 0;
  for (Json state = render.json("/state"); !state.is_null() && state["ended"] == false;
       state = render.json("/state")) {
    pictures = state["picture"];
    (void)render.body("/picture.png?exposure=" + std::to_string(pictures % 5));
  }
  render.wait_for_exit();
  EXPECT_GT(pictures, 0);
  EXPECT_TRUE(read_file(file("alone.exr")) == read_file(file("watched.exr")));
}

TEST(Preview, NothingListensUnlessAsked) {
  const auto sockets = [](const std::string& pid) {
    return std::stoi(shell("ls -l /proc/" + pid + "/fd | grep -c socket: || true").out);
  };
  const std::string lock = file(".quiet.exr.lock");
  const Outcome run = shell(ABBE_BINARY " render " + ball() + " --quiet --time 20s -o " + file("quiet.exr") +
                            " & pid=$!; until [ -e " + lock +
                            " ]; do sleep 0.01; done; sleep 0.3; "
                            "ls -l /proc/$pid/fd | grep -c socket:; kill -9 $pid");
  EXPECT_EQ(run.out, "0\n");
  const Watched render("--time 20s -o " + file("asked.exr"));
  EXPECT_GT(sockets(render.pid()), 0);
}

TEST(Preview, APortThatIsTakenOrNoneEndsTheCommandBeforeItRenders) {
  const Watched render("--time 20s -o " + file("first.exr"));
  const Outcome second =
      abbe("render " + ball() + " -o " + file("b.exr") + " --preview " + std::to_string(render.port()));
  EXPECT_EQ(second.code, 5);
  EXPECT_NE(second.err.find("127.0.0.1:" + std::to_string(render.port()) + ": cannot be listened on"),
            std::string::npos)
      << second.err;
  EXPECT_FALSE(std::filesystem::exists(file("b.exr")));
  for (const char* address : {"port", "70000", ":80", "1.2.3.4:", "-1"}) {
    const Outcome none = abbe("render " + ball() + " -o " + file("b.exr") + " --preview=" + address);
    EXPECT_EQ(none.code, 2) << address;
    EXPECT_NE(none.err.find("--preview"), std::string::npos) << none.err;
  }
}

TEST(Tev, IsShownTheFilmThatIsWritten) {
  TevListener viewer;
  const std::string port = std::to_string(viewer.address().port);
  const Outcome run =
      abbe("render " + ball() + " --quiet --time 0.3s -o " + file("tev.exr") + " --tev " + port);
  EXPECT_EQ(run.code, 0) << run.err;
  viewer.wait();
  const Image film = read_exr(file("tev.exr"));
  ASSERT_EQ(viewer.channels.size(), 3U);
  for (const auto& [channel, values] : viewer.channels)
    EXPECT_EQ(values, film.find(channel)->values) << channel;
  const Outcome none = abbe("render " + ball() + " -o " + file("none.exr") + " --tev " + port);
  EXPECT_EQ(none.code, 5);
  EXPECT_NE(none.err.find("127.0.0.1:" + port + ": no viewer listens there"), std::string::npos) << none.err;
}

}  // namespace
}  // namespace abbe::test
