// What the tests of bad input share.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "core/input/input_error.hpp"

namespace hagfish {

/// The message of the InputError that `action` throws; checks that it is one line.
inline std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    return message;
  }
  return "no error";
}

}  // namespace hagfish
