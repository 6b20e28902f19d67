// What a user's file or option got wrong.
#pragma once

#include <stdexcept>

namespace hagfish {

/// Bad input: what() is one line that names the file, the key where there is one, and the reason.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace hagfish
