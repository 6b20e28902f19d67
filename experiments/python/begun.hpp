// Objects of Python whose __init__ was never called: pybind11 takes what they have for an object.
#pragma once

#include <pybind11/pybind11.h>

#include <string>

namespace hagfish {

/// Whether `object`, of a type that pybind11 made, has what its __init__ makes.
inline bool has_begun(pybind11::handle object) {
  auto* const instance = reinterpret_cast<pybind11::detail::instance*>(object.ptr());
  return instance->get_value_and_holder().instance_registered();
}

/// pybind11's caster, which raises TypeError for such an object.
template <class Type>
class BegunCaster : public pybind11::detail::type_caster_base<Type> {
 public:
  bool load(pybind11::handle source, bool convert) {
    if (!pybind11::detail::type_caster_base<Type>::load(source, convert)) return false;
    if (source.is_none() || has_begun(source)) return true;
    throw pybind11::type_error(std::string(Py_TYPE(source.ptr())->tp_name) +
                               ".__init__() was not called");
  }
};

}  // namespace hagfish
