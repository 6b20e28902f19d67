// What an exception says to the user.
#pragma once

#include <exception>
#include <string>

namespace hagfish {

/// The user's file or option is at fault: InputError and FileError.
bool is_bad_input(const std::exception& error);

/// The reason in one line, printable (input_text.hpp). "out of memory" of std::bad_alloc; of an
/// exception that this code and its libraries throw with a message for the reader, that message; of
/// any other one "internal error: " before it.
std::string reason(const std::exception& error);

}  // namespace hagfish
