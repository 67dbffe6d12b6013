#pragma once

#include <functional>
#include <string>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "io/error.h"

namespace abbe::test {

using nlohmann::json;

/// The JSON that a command prints.
template <typename Options>
json json_output(void (*command)(const Options&), Options options) {
  options.json = true;
  testing::internal::CaptureStdout();
  EXPECT_NO_THROW(command(options));
  const std::string answer = testing::internal::GetCapturedStdout();
  return answer.empty() ? json() : json::parse(answer);
}

/// Code of the error with which a command ends. Its message must contain `words`.
inline ErrorCode fault(const std::function<void()>& command, const std::string& words) {
  try {
    command();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find(words), std::string::npos) << e.what();
    return e.code;
  }
  ADD_FAILURE() << "accepted";
  return ErrorCode::internal;
}

}  // namespace abbe::test
