// What the tests of bad input and bad files share.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "core/input/input_error.hpp"

namespace hagfish {

/// The message of the Error that `action` throws; checks that it is one line.
template <class Error = InputError>
std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    return message;
  }
  return "no error";
}

}  // namespace hagfish
