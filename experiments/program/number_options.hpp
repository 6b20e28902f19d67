// What numbers an option takes. The checks of CLI11 let "nan" pass, and "inf" with some.
#pragma once

#include <CLI/CLI.hpp>

namespace hagfish {

/// Lets an option take finite numbers above 0 only.
CLI::Validator above_zero();

/// Lets an option take finite numbers from `least` to `most` only.
CLI::Validator from_to(double least, double most);

}  // namespace hagfish
