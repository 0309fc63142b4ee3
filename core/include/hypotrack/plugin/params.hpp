#pragma once

#include <Eigen/Core>
#include <concepts>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "hypotrack/api/config.hpp"
#include "hypotrack/api/export.hpp"

namespace hypotrack {

/// Factors for ParamInfo::to_si.
inline constexpr double kMillimetre = 1e-3;
inline constexpr double kDegree = std::numbers::pi / 180.0;

/// Description of a parameter. `min` and `max` are inclusive and in the unit of the YAML file. The
/// value in the struct is the YAML value times `to_si`: `range_deg` is stored in radians.
struct ParamInfo {
  std::string_view help;
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  std::string_view unit = "";
  double to_si = 1.0;
  bool required = false;
};

class ParamVisitor;

/// A struct whose `visit` names every parameter. Parsing, errors, help and the dump that makes a
/// run repeatable follow from it.
///
///   struct PsoParams {
///     int particles = 64;
///     void visit(hypotrack::ParamVisitor& v) {
///       v("particles", particles, {.help = "particles of the swarm", .min = 2, .max = 1 << 20});
///     }
///   };
template <class T>
concept ParamStruct = requires(T& t, ParamVisitor& v) {
  t.visit(v);
};

/// An enumeration that a parameter may hold. `enum_names(T)`, found by argument-dependent lookup,
/// returns the YAML words of enumerators 0, 1, 2, ...
template <class T>
concept ParamEnum = std::is_enum_v<T> && requires(T t) {
  { enum_names(t) } -> std::convertible_to<std::span<const std::string_view>>;
};

/// Visitor of the parameters of a struct: a reader, a help writer or a dump.
/// Allowed types: bool, integers, double, std::string, std::filesystem::path (relative to the file
/// that it is written in), ParamEnum, fixed-size Eigen vectors of double, std::vector of double or
/// std::string, nested ParamStruct, std::vector of ParamStruct, std::optional of any scalar type
/// above (empty if the key is absent), and ConfigNode (unread, for a nested plugin).
class HYPOTRACK_API ParamVisitor {
 public:
  virtual ~ParamVisitor();

  template <class T>
  void operator()(std::string_view key, T& value, const ParamInfo& info);

 protected:
  // Scalars: a reader replaces `value`, a writer leaves it unchanged.
  virtual void on_bool(std::string_view key, bool& value, const ParamInfo& info) = 0;
  virtual void on_int(std::string_view key, std::int64_t& value, std::int64_t lowest,
                      std::int64_t highest, const ParamInfo& info) = 0;
  virtual void on_double(std::string_view key, double& value, const ParamInfo& info) = 0;
  virtual void on_string(std::string_view key, std::string& value, const ParamInfo& info) = 0;
  virtual void on_path(std::string_view key, std::filesystem::path& value,
                       const ParamInfo& info) = 0;
  virtual void on_enum(std::string_view key, int& value, std::span<const std::string_view> names,
                       const ParamInfo& info) = 0;
  // Lists of scalars; `fixed_size` is 0 where any length is allowed.
  virtual void on_doubles(std::string_view key, std::vector<double>& value, std::size_t fixed_size,
                          const ParamInfo& info) = 0;
  virtual void on_strings(std::string_view key, std::vector<std::string>& value,
                          const ParamInfo& info) = 0;
  virtual void on_config(std::string_view key, ConfigNode& value, const ParamInfo& info) = 0;
  // Nested maps and lists of maps: enter_section() returns whether to visit the map, enter_list()
  // the number of items to visit.
  virtual bool enter_section(std::string_view key, const ParamInfo& info) = 0;
  virtual void leave_section() = 0;
  virtual std::size_t enter_list(std::string_view key, std::size_t size, const ParamInfo& info) = 0;
  /// Returns true if the item starts from its struct's defaults. A reader does so, because it does
  /// not merge list items with those of a default list.
  virtual bool enter_item(std::size_t index) = 0;
  virtual void leave_item() = 0;
  virtual void leave_list() = 0;
  // Optional scalars: returns whether to visit the value. A reader visits it if the key is present,
  // a dump if it has a value, help always.
  virtual bool enter_optional(std::string_view key, bool has_value, const ParamInfo& info) = 0;
};

/// Reads a struct of parameters strictly. Unknown, duplicate and missing keys, wrong types and
/// values out of range throw ConfigError with `file:line:column`, what was found, what is allowed
/// and the nearest name. Keys in `also_allowed` (`type`, `name`, `weight`) are skipped, because
/// another reader handles them.
class HYPOTRACK_API ParamReader {
 public:
  explicit ParamReader(ConfigNode node, std::vector<std::string> also_allowed = {});
  ~ParamReader();
  ParamReader(const ParamReader&) = delete;
  ParamReader& operator=(const ParamReader&) = delete;

  template <ParamStruct P>
  P read(P params = P{}) {  // keys that are absent keep the values of `params`
    params.visit(visitor());
    finish();
    return params;
  }

 private:
  ParamVisitor& visitor();
  void finish();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Type-erased `visit` of a struct of parameters.
using ParamVisit = void (*)(void* params, ParamVisitor& visitor);

/// Writes every parameter and its value as YAML; ParamReader reads it back to equal values.
HYPOTRACK_API std::string dump_params(void* params, ParamVisit visit);
/// Describes each parameter in one line: key, type, default, unit, range and help.
HYPOTRACK_API std::string describe_params(void* params, ParamVisit visit);

template <ParamStruct P>
std::string dump_params(P params) {
  return dump_params(&params, [](void* p, ParamVisitor& v) { static_cast<P*>(p)->visit(v); });
}

template <ParamStruct P>
std::string describe_params() {
  P params{};
  return describe_params(&params, [](void* p, ParamVisitor& v) { static_cast<P*>(p)->visit(v); });
}

// ---------------------------------------------------------------------------------------------

namespace detail {
template <class T>
inline constexpr bool is_optional = false;
template <class T>
inline constexpr bool is_optional<std::optional<T>> = true;
template <class T>
inline constexpr bool is_vector = false;
template <class T>
inline constexpr bool is_vector<std::vector<T>> = true;
/// True for Eigen types, which also have a `visit` but are not structs of parameters.
template <class T>
inline constexpr bool is_eigen = requires {
  T::SizeAtCompileTime;
};
}  // namespace detail

template <class T>
void ParamVisitor::operator()(std::string_view key, T& value, const ParamInfo& info) {
  if constexpr (std::is_same_v<T, bool>) {
    on_bool(key, value, info);
  } else if constexpr (std::is_integral_v<T>) {
    static_assert(sizeof(T) < 8 || std::is_signed_v<T>, "unsigned 64-bit parameters do not fit");
    auto wide = static_cast<std::int64_t>(value);
    on_int(key, wide, static_cast<std::int64_t>(std::numeric_limits<T>::min()),
           static_cast<std::int64_t>(std::numeric_limits<T>::max()), info);
    value = static_cast<T>(wide);
  } else if constexpr (std::is_same_v<T, double>) {
    on_double(key, value, info);
  } else if constexpr (std::is_same_v<T, std::string>) {
    on_string(key, value, info);
  } else if constexpr (std::is_same_v<T, std::filesystem::path>) {
    on_path(key, value, info);
  } else if constexpr (std::is_same_v<T, ConfigNode>) {
    on_config(key, value, info);
  } else if constexpr (ParamEnum<T>) {
    int index = static_cast<int>(value);
    on_enum(key, index, enum_names(value), info);
    value = static_cast<T>(index);
  } else if constexpr (detail::is_optional<T>) {
    if (enter_optional(key, value.has_value(), info)) {
      auto inner = value.value_or(typename T::value_type{});
      (*this)(key, inner, info);
      value = inner;
    }
  } else if constexpr (std::is_same_v<T, std::vector<double>>) {
    on_doubles(key, value, 0, info);
  } else if constexpr (std::is_same_v<T, std::vector<std::string>>) {
    on_strings(key, value, info);
  } else if constexpr (detail::is_vector<T>) {
    value.resize(enter_list(key, value.size(), info));
    for (std::size_t i = 0; i < value.size(); ++i) {
      if (enter_item(i)) value[i] = typename T::value_type{};
      value[i].visit(*this);
      leave_item();
    }
    leave_list();
  } else if constexpr (detail::is_eigen<T>) {
    static_assert(T::SizeAtCompileTime > 0, "fixed-size Eigen vectors of double only");
    std::vector<double> items(value.data(), value.data() + value.size());
    on_doubles(key, items, static_cast<std::size_t>(T::SizeAtCompileTime), info);
    value = Eigen::Map<const T>(items.data());
  } else {
    static_assert(ParamStruct<T>,
                  "a parameter cannot have this type: use bool, integers, double, std::string, "
                  "std::filesystem::path, an enum with enum_names(), a fixed-size Eigen vector of "
                  "double, a struct with visit(), std::vector or std::optional of these");
    if constexpr (ParamStruct<T>) {
      if (enter_section(key, info)) {
        value.visit(*this);
        leave_section();
      }
    }
  }
}

}  // namespace hypotrack
