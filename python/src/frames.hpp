#pragma once

#include <vector>

#include "arrays.hpp"
#include "hypotrack/api/frame.hpp"

namespace hypotrack::python {

/// Returns a view of a colour picture, or of a View. Throws DataError, naming `what`.
View view_of(const py::handle& object, const std::string& what);
/// Returns views of a sequence of colour pictures or Views; None or an empty one: no usable frame.
std::vector<View> views_of(const py::handle& objects);

}  // namespace hypotrack::python
