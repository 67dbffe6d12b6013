#include "python/json.h"

#include <cmath>

#include <fmt/format.h>

#include "io/diagnostics.h"
#include "io/json.h"
#include "io/json_values.h"
#include "python/arguments.h"
#include "python/numbers.h"

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

// Text of a number in messages. Python itself refuses to convert very long ints.
std::string text_of(const py::handle& number) {
  if (!PyLong_Check(number.ptr())) return py::str(number);
  const auto bits = number.attr("bit_length")().cast<std::size_t>();
  return bits > 1024 ? fmt::format("an int of {} bits", bits) : std::string(py::str(number));
}

class Converter {
  using Value = decltype(JsonValue::value);

 public:
  explicit Converter(std::string pointer) : pointer_(std::move(pointer)) {}

  Value value_of(const py::handle& object) {
    if (depth_ > ValueTree::kMaxDepth) refuse("", fmt::format("nested deeper than {}", ValueTree::kMaxDepth));
    ++depth_;
    Value value = plain_value_of(object);
    --depth_;
    return value;
  }

 private:
  Value plain_value_of(const py::handle& object) {
    if (object.is_none()) return nullptr;
    if (py::isinstance<py::bool_>(object)) return object.cast<bool>();
    if (py::isinstance<py::int_>(object) || py::isinstance<py::float_>(object)) return number_of(object);
    if (py::isinstance<py::str>(object)) return utf8_of(object);
    if (py::isinstance<py::dict>(object)) return members_of(py::reinterpret_borrow<py::dict>(object));
    if (py::isinstance<py::list>(object) || py::isinstance<py::tuple>(object))
      return elements_of(py::reinterpret_borrow<py::sequence>(object));
    // Dates and time spans, which numpy converts to plain numbers if their unit is the nanosecond.
    if (const char kind = numpy_kind(object); kind == 'm' || kind == 'M')
      refuse_kind(py::str(object.attr("dtype")));
    for (const char* method : {"tolist", "__fspath__"})
      if (py::hasattr(object, method)) return converted(object, object.attr(method)());
    refuse_kind(type_name(object));
  }

  // Converts the plain equivalent of an object. A numpy long double remains its own type, because Python has
  // none for it.
  Value converted(const py::handle& object, const py::object& replacement) {
    if (!py::type::handle_of(replacement).is(py::type::handle_of(object))) return value_of(replacement);
    const py::object real = py::module_::import("numbers").attr("Real");
    if (!py::isinstance(replacement, real)) refuse_kind(type_name(object));
    return number_of(replacement);
  }

  [[noreturn]] void refuse_kind(const std::string& kind) const {
    refuse(pointer_, fmt::format("expected a value that JSON can represent (got a {})", kind));
  }

  // UTF-8 of a text for JSON. Python texts, such as file names, need not have one.
  [[nodiscard]] std::string utf8_of(const py::handle& text) const {
    py::ssize_t size = 0;
    const char* const bytes = PyUnicode_AsUTF8AndSize(text.ptr(), &size);
    if (bytes != nullptr) return {bytes, static_cast<std::size_t>(size)};
    PyErr_Clear();
    refuse(pointer_, no_utf8(text));
  }

  [[nodiscard]] double number_of(const py::handle& object) const {
    const double number = PyFloat_AsDouble(object.ptr());
    const bool too_large = PyErr_Occurred() != nullptr;  // an int larger than every double
    PyErr_Clear();
    if (too_large || !std::isfinite(number))
      refuse(pointer_, fmt::format("expected a finite number (got {})", text_of(object)));
    if (PyLong_Check(object.ptr()) && !py::int_(py::float_(number)).equal(object))
      refuse(pointer_,
             fmt::format("expected a number that a double represents exactly (got {})", text_of(object)));
    return number;
  }

  JsonValue inner(const std::string& key, const py::handle& object) {
    const std::size_t outer = pointer_.size();
    pointer_ += '/' + key;
    JsonValue value{value_of(object), {}, 0};
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
      const std::string name = utf8_of(key);
      members.push_back({name, inner(escaped_key(name), value)});
    }
    return members;
  }

  std::string pointer_;
  std::size_t depth_ = 0;  // of the current value, 0 at the root
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

JsonValue to_json(const py::handle& object, const std::string& pointer) {
  return {Converter(pointer).value_of(object), {}, 0};
}

py::object to_python(const JsonValue& value) {
  return std::visit(ToPython{}, value.value);
}

}  // namespace abbe::python
