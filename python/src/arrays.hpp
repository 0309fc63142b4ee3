#pragma once

#include <pybind11/numpy.h>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "common.hpp"
#include "hypotrack/api/frame.hpp"

// numpy arrays as matrices and pictures, and back.

namespace hypotrack::python {

/// What a caller gives for an array of numbers, as float64 with rows one after the other. What is
/// no array of numbers is taken, too: the functions below refuse it, with the argument's name.
struct Numbers {
  using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;
  Array array;             ///< null if it is none; ndim() is -1
  std::string found = {};  ///< the shape, or what was found instead

  py::ssize_t ndim() const { return array ? array.ndim() : -1; }
  py::ssize_t size() const { return array.size(); }
  py::ssize_t shape(py::ssize_t axis) const { return array.shape(axis); }
  const double* data() const { return array.data(); }
  /// Returns a message: expected an array of that shape.
  std::string problem(const char* what, const std::string& shape) const;
  /// Throws Error with it.
  [[noreturn]] void refuse(const char* what, const std::string& shape) const {
    throw Error(problem(what, shape));
  }
};
Numbers numbers_of(const py::handle& object);

/// States or points: an array (N, D), or (D) for one.
using ColumnsMap = Eigen::Map<const Eigen::MatrixXd>;

enum class Pixels { color, mask, depth };

/// Returns a picture that shares the array's memory and keeps it alive: uint8 (H, W, 3) in BGR,
/// uint8 or bool (H, W) of a mask, float32 (H, W) of a depth map. Throws DataError, naming `what`,
/// on other types, shapes and rows with gaps.
cv::Mat picture_of(const py::handle& array, Pixels pixels, const std::string& what);

/// Returns a read-only array that shares the picture's memory; None for an empty picture.
py::object array_of(const cv::Mat& picture);

/// Returns the states or points of an array as columns (DxN), without a copy. Throws Error unless
/// its last axis has `dimension` numbers.
ColumnsMap columns_of(const Numbers& array, Eigen::Index dimension, const char* what);

/// Returns an array (D) or (N, D) with the columns (DxN) of a matrix; (D) if `flat`.
template <class Scalar>
py::array_t<Scalar> rows_of(const Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>& columns,
                            bool flat = false) {
  std::vector<py::ssize_t> shape;
  if (!flat) shape.push_back(columns.cols());
  shape.push_back(columns.rows());
  return py::array_t<Scalar>(shape, columns.data());  // copies
}

/// Returns an array of the numbers of a vector.
py::array_t<double> array_of(const Eigen::VectorXd& vector);
py::array_t<double> array_of(const std::vector<double>& numbers);
/// Returns an array (N, 3) with the points of a matrix (3xN).
py::array_t<double> points_of(const Eigen::Matrix3Xd& points);
/// Returns a vector of an array (D), or (N) of any length. Throws Error, naming `what`, on other
/// shapes.
Eigen::VectorXd vector_of(const Numbers& array, Eigen::Index size, const char* what);
Eigen::VectorXd vector_of(const Numbers& array, const char* what);
/// Returns the same. Throws Error if a number is not finite.
Eigen::VectorXd finite_vector_of(const Numbers& array, Eigen::Index size, const char* what);
/// Returns a matrix of an array (R, C). Throws Error, naming `what`, on other shapes.
Eigen::MatrixXd matrix_of(const Numbers& array, Eigen::Index rows, Eigen::Index columns,
                          const char* what);
/// Returns points (3xN) of an array (N, 3). Throws Error, naming `what`, on other shapes.
Eigen::Matrix3Xd matrix_of_points(const Numbers& array, const char* what);

/// Returns a view of a colour picture, or of a View. Throws DataError, naming `what`.
View view_of(const py::handle& object, const std::string& what);
/// Returns views of a sequence of colour pictures or Views; None or an empty one: no usable frame.
std::vector<View> views_of(const py::handle& objects);

/// Throws Error unless a blur is a number of pixels, 0 or more.
void check_blur(double blur);

/// Returns `(480, 640, 3)`.
std::string shape_text(const py::array& array);

}  // namespace hypotrack::python

/// Takes any object for Numbers. Signatures show it as an array.
template <>
struct pybind11::detail::type_caster<hypotrack::python::Numbers> {
  PYBIND11_TYPE_CASTER(hypotrack::python::Numbers, const_name("numpy.ndarray[numpy.float64]"));
  bool load(handle source, bool /*convert*/) {
    value = hypotrack::python::numbers_of(source);
    return true;
  }
};
