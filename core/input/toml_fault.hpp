// Errors of the TOML parser in one line, for programs that do not catch them.
#pragma once

#include <exception>
#include <optional>
#include <string>
#include <typeinfo>

namespace hagfish {

/// What `thrown`, which is of `type`, says of bad syntax, as InputError would have it; nothing
/// where it is not of the parser's.
std::optional<std::string> toml_fault(const std::exception& thrown, const std::type_info& type);

}  // namespace hagfish
