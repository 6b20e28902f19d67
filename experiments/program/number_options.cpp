#include "experiments/program/program.hpp"

#include <fmt/format.h>

#include "core/input/input_text.hpp"

namespace hagfish {

CLI::Validator above_zero() {
  const auto reject = [](const std::string& word) {
    const std::optional<double> number = finite_number(word);
    return number && *number > 0 ? std::string()
                                 : shortened(word) + " is not a finite number above 0";
  };
  return CLI::Validator(reject, "ABOVE 0");
}

CLI::Validator from_to(double least, double most) {
  const auto reject = [least, most](const std::string& word) {
    const std::optional<double> number = finite_number(word);
    return number && *number >= least && *number <= most
               ? std::string()
               : fmt::format("{} is not a number from {:g} to {:g}", shortened(word), least, most);
  };
  return CLI::Validator(reject, fmt::format("FROM {:g} TO {:g}", least, most));
}

}  // namespace hagfish
