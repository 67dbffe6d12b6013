#include "python/json.h"

#include <cmath>

#include <fmt/format.h>

#include "io/invalid_input.h"
#include "io/json_values.h"
#include "io/value_tree.h"

namespace abbe::python {
namespace {

namespace py = pybind11;

[[noreturn]] void refuse(const std::string& pointer, const std::string& message) {
  Diagnostics diagnostics;
  diagnostics.error({nullptr, 0, pointer}, message);
  throw InvalidInput(ErrorCode::scene, "invalid input\n" + format(diagnostics.all().front()),
                     {diagnostics.all().begin(), diagnostics.all().end()});
}

std::string type_name(const py::handle& object) {
  return py::str(py::type::handle_of(object).attr("__name__"));
}

// A key as a JSON pointer has it [RFC6901].
std::string escaped(const std::string& key) {
  std::string all;
  for (const char c : key) all += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
  return all;
}

class Converter {
 public:
  decltype(JsonValue::value) value_of(const py::handle& object) {
    if (object.is_none()) return nullptr;
    if (py::isinstance<py::bool_>(object)) return object.cast<bool>();
    if (py::isinstance<py::int_>(object) || py::isinstance<py::float_>(object)) return number_of(object);
    if (py::isinstance<py::str>(object)) return object.cast<std::string>();
    if (py::isinstance<py::dict>(object)) return members_of(py::reinterpret_borrow<py::dict>(object));
    if (py::isinstance<py::list>(object) || py::isinstance<py::tuple>(object))
      return elements_of(py::reinterpret_borrow<py::sequence>(object));
    if (py::hasattr(object, "tolist")) return value_of(object.attr("tolist")());
    if (py::hasattr(object, "__fspath__")) return value_of(object.attr("__fspath__")());
    refuse(pointer_, fmt::format("expected what JSON can hold (got a {})", type_name(object)));
  }

 private:
  [[nodiscard]] double number_of(const py::handle& object) const {
    const double number = PyFloat_AsDouble(object.ptr());
    const bool too_large = PyErr_Occurred() != nullptr;  // an int beyond all doubles
    PyErr_Clear();
    if (too_large || !std::isfinite(number))
      refuse(pointer_, fmt::format("expected a finite number (got {})", std::string(py::str(object))));
    return number;
  }

  JsonValue inner(const std::string& key, const py::handle& object) {
    const std::size_t outer = pointer_.size();
    pointer_ += '/' + key;
    if (++depth_ > ValueTree::kMaxDepth)
      refuse("", fmt::format("nested deeper than {}", ValueTree::kMaxDepth));
    JsonValue value{value_of(object), {}, 0};
    --depth_;
    pointer_.resize(outer);
    return value;
  }

  JsonValue::Array elements_of(const py::sequence& list) {
    JsonValue::Array elements;
    elements.reserve(list.size());
    for (const py::handle element : list) elements.push_back(inner(std::to_string(elements.size()), element));
    return elements;
  }

  JsonValue::Object members_of(const py::dict& dict) {
    JsonValue::Object members;
    for (const auto& [key, value] : dict) {
      if (!py::isinstance<py::str>(key))
        refuse(pointer_, fmt::format("expected keys that are strings (got a {})", type_name(key)));
      const auto name = key.cast<std::string>();
      members.push_back({name, inner(escaped(name), value)});
    }
    return members;
  }

  std::string pointer_;
  std::size_t depth_ = 0;
};

py::object number(double value) {
  if (value == std::floor(value) && std::abs(value) <= kLargestInteger && !std::signbit(value))
    return py::int_(static_cast<std::int64_t>(value));
  return py::float_(value);
}

struct ToPython {
  py::object operator()(std::nullptr_t) const { return py::none(); }
  py::object operator()(bool value) const { return py::bool_(value); }
  py::object operator()(double value) const { return number(value); }
  py::object operator()(const std::string& value) const { return py::str(value); }
  py::object operator()(const JsonValue::Array& array) const {
    py::list list;
    for (const JsonValue& value : array) list.append(to_python(value));
    return list;
  }
  py::object operator()(const JsonValue::Object& object) const {
    py::dict dict;
    for (const JsonValue::Member& member : object) dict[py::str(member.first)] = to_python(member.second);
    return dict;
  }
};

}  // namespace

JsonValue to_json(const py::handle& object) {
  return {Converter().value_of(object), {}, 0};
}

py::object to_python(const JsonValue& value) {
  return std::visit(ToPython{}, value.value);
}

}  // namespace abbe::python
