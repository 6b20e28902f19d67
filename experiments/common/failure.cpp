#include "experiments/common/failure.hpp"

#include <algorithm>
#include <new>
#include <stdexcept>

#include "core/input/input_error.hpp"
#include "core/input/input_text.hpp"
#include "core/log/hdf5/hdf5_error.hpp"
#include "experiments/common/text_file.hpp"

namespace hagfish {
namespace {

template <class... Kinds>
bool is_one_of(const std::exception& error) {
  return ((dynamic_cast<const Kinds*>(&error) != nullptr) || ...);
}

}  // namespace

bool is_bad_input(const std::exception& error) {
  return is_one_of<InputError, FileError>(error) && !is_one_of<WriteError>(error);
}

std::string reason(const std::exception& error) {
  if (is_one_of<std::bad_alloc>(error)) {
    return "out of memory";
  }
  const bool for_the_reader =
      is_one_of<std::runtime_error, std::domain_error, std::invalid_argument>(error);
  std::string text = (for_the_reader ? "" : "internal error: ") + std::string(error.what());
  std::replace(text.begin(), text.end(), '\n', ' ');
  return printable(text);
}

}  // namespace hagfish
