#include "cli/arguments.h"

#include <exception>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include "cli/commands.h"
#include "description/render.h"

namespace abbe::cli {
namespace {

template <typename F>
std::string refusal(F parse) {
  try {
    parse();
  } catch (const Error& e) {
    EXPECT_EQ(e.code, ErrorCode::usage);
    return e.what();
  }
  return "accepted";
}

TEST(Arguments, NumbersAreSeparatedByCommasAndChecked) {
  EXPECT_EQ(parse_numbers("--at", "400, 550.5", 300, 1100), (std::vector<double>{400, 550.5}));
  EXPECT_EQ(refusal([] { return parse_numbers("--at", "400,x", 300, 1100); }),
            "--at: got \"400,x\", allowed numbers separated by commas");
  EXPECT_EQ(refusal([] { return parse_numbers("--at", "400,1200", 300, 1100); }),
            "--at: got 1200, allowed [300, 1100]");
  EXPECT_NE(refusal([] { return parse_numbers("--at", "nan", 300, 1100); }), "accepted");
  EXPECT_NE(refusal([] { return parse_numbers("--at", "", 300, 1100); }), "accepted");
}

TEST(Arguments, IntegersAreWholeAndInRange) {
  EXPECT_EQ(parse_integer("--spp", "16777216", 1, 1 << 24), 1 << 24);
  EXPECT_EQ(parse_integer("--spp", "1e3", 1, 1 << 24), 1000);
  for (const char* text : {"", "x", "0", "1.5", "-1", "16777217", "1e300"})
    EXPECT_EQ(refusal([&] { return parse_integer("--spp", text, 1, 1 << 24); }),
              fmt::format("--spp: got \"{}\", allowed whole numbers in [1, 16777216]", text));
}

// Doubles distinguish this integer from its neighbours, but not the next one.
TEST(Arguments, WholeNumbersAreNotRounded) {
  EXPECT_EQ(parse_integer("--seed", "9007199254740991", 0, kMaxSeed), kMaxSeed);
  EXPECT_NE(refusal([] { return parse_integer("--seed", "9007199254740992", 0, kMaxSeed); }), "accepted");
  EXPECT_NE(refusal([] { return parse_integer("--seed", "9007199254740993", 0, kMaxSeed); }), "accepted");
}

TEST(Arguments, ChoicesGoByName) {
  EXPECT_EQ(parse_choice("--integrator", "path", {"auto", "path"}), 1U);
  EXPECT_EQ(refusal([] {
              return parse_choice("--integrator", "1", {"auto", "path"});
            }),
            "--integrator: got \"1\", allowed auto, path");
}

TEST(Arguments, TriplesHaveThreeNumbers) {
  EXPECT_EQ(parse_triple("--dir", "-1,0.5,2e3"), (std::array<double, 3>{-1, 0.5, 2000}));
  EXPECT_NE(refusal([] { return parse_triple("--dir", "1,2"); }), "accepted");
  EXPECT_EQ(parse_triple("--dir", "0,-3e38,1e-300"), (std::array<double, 3>{0, -3e38, 1e-300}));
  EXPECT_EQ(refusal([] { return parse_triple("--dir", "1e155,0,1e155"); }),
            "--dir: got 1e155, allowed [-3.402823466e+38, 3.402823466e+38]");
}

TEST(Arguments, TimesHaveUnits) {
  EXPECT_EQ(parse_seconds("--time", "60s"), 60);
  EXPECT_EQ(parse_seconds("--time", "2m"), 120);
  EXPECT_EQ(parse_seconds("--time", "1.5h"), 5400);
  EXPECT_EQ(parse_seconds("--time", "7"), 7);
  for (const char* text : {"", "s", "0s", "-1s", "5d", "1 s x"})
    EXPECT_NE(refusal([&] { return parse_seconds("--time", text); }), "accepted") << text;
}

TEST(Arguments, SharesArePercentOrPlain) {
  EXPECT_DOUBLE_EQ(parse_fraction("--error", "0.5%"), 0.005);
  EXPECT_DOUBLE_EQ(parse_fraction("--error", "0.005"), 0.005);
  for (const char* text : {"", "%", "0", "1", "100%", "-1%"})
    EXPECT_NE(refusal([&] { return parse_fraction("--error", text); }), "accepted") << text;
}

TEST(Arguments, AmountsOfMemoryHaveUnits) {
  EXPECT_EQ(parse_bytes("--max-memory", "4G"), 4000000000U);
  EXPECT_EQ(parse_bytes("--max-memory", "1.5M"), 1500000U);
  EXPECT_EQ(parse_bytes("--max-memory", "12"), 12U);
  for (const char* text : {"", "G", "0", "-1M", "1T", "0.1", "1e30"})
    EXPECT_NE(refusal([&] { return parse_bytes("--max-memory", text); }), "accepted") << text;
}

TEST(Arguments, CropsAreWholeAndNotEmpty) {
  const Crop crop = parse_crop("--crop", "1,2,30,40");
  EXPECT_EQ(crop.x0, 1);
  EXPECT_EQ(crop.y0, 2);
  EXPECT_EQ(crop.x1, 30);
  EXPECT_EQ(crop.y1, 40);
  for (const char* text : {"1,2,3", "1,2,1,3", "1,3,2,3", "0.5,0,1,1", "-1,0,1,1", "0,0,1e9,1"})
    EXPECT_NE(refusal([&] { return parse_crop("--crop", text); }), "accepted") << text;
}

TEST(Arguments, AddressesAreAPortOrAHostAndAPort) {
  EXPECT_EQ(parse_server_address("--preview", "0").host, "127.0.0.1");
  const ServerAddress v6 = parse_viewer_address("--tev", "[::1]:14158");
  EXPECT_EQ(v6.host, "::1");
  EXPECT_EQ(v6.port, 14158);
  EXPECT_EQ(parse_viewer_address("--tev", "desk:1").host, "desk");
  for (const char* text : {"0", "desk:0"})
    EXPECT_NE(refusal([&] { return parse_viewer_address("--tev", text); }).find("[1, 65535]"),
              std::string::npos)
        << text;
}

TEST(Arguments, OverridesArePointerAndValue) {
  const Override set = parse_override("--set", "/lights/0/name=a=b");
  EXPECT_EQ(set.pointer, "/lights/0/name");
  EXPECT_EQ(set.value, "a=b");
  EXPECT_NE(refusal([] { return parse_override("--set", "samples=3"); }), "accepted");
  EXPECT_NE(refusal([] { return parse_override("--set", "/samples"); }), "accepted");
}

// Error of the command line; empty without an error.
std::string fault_of(CLI::App& app, const std::vector<std::string>& words) {
  try {
    app.parse(std::vector<std::string>(words.rbegin(), words.rend()));
  } catch (const std::exception& fault) {
    return fault.what();
  }
  return "";
}

// Passes an empty text to every option and argument of a command and of its subcommands, and counts them.
int expect_refused_empty(CLI::App& app, const CLI::App& command, const std::vector<std::string>& words) {
  int count = 0;
  bool first = true;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_items_expected_min() == 0) continue;
    if (!option->nonpositional() && !std::exchange(first, false)) continue;  // others follow the first
    ++count;
    std::vector<std::string> line = words;
    if (option->nonpositional()) line.push_back(option->get_name());
    line.emplace_back();
    EXPECT_NE(fault_of(app, line).find("got an empty value, allowed "), std::string::npos)
        << fmt::format("{}", fmt::join(line, " "));
  }
  for (const CLI::App* within : command.get_subcommands([](const CLI::App*) { return true; })) {
    std::vector<std::string> line = words;
    line.push_back(within->get_name());
    count += expect_refused_empty(app, *within, line);
  }
  return count;
}

TEST(Arguments, NoOptionTakesAnEmptyText) {
  CLI::App app;
  Command command;
  add_commands(app, command);
  EXPECT_GT(expect_refused_empty(app, app, {}), 100);
  for (const std::string argument : {"--output=", "--checkpoint=", "--set="}) {
    try {
      check_names(app, {"render", argument, "scene.json"});
      FAIL() << argument << " takes the next argument";
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ErrorCode::usage);
      EXPECT_NE(std::string(error.what()).find("got an empty value"), std::string::npos) << error.what();
    }
  }
  EXPECT_NO_THROW(check_names(app, {"render", "--set=/render/samples=1", "scene.json"}));
}

}  // namespace
}  // namespace abbe::cli
