#include "arrays.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

namespace hypotrack::python {
namespace {

/// Keeps arrays alive as long as pictures use their memory.
class ArrayKeeper final : public cv::MatAllocator {
 public:
  cv::UMatData* allocate(int dimensions, const int* sizes, int type, void* data, std::size_t* steps,
                         cv::AccessFlag flags, cv::UMatUsageFlags usage) const override {
    return cv::Mat::getDefaultAllocator()->allocate(dimensions, sizes, type, data, steps, flags,
                                                    usage);
  }
  bool allocate(cv::UMatData* data, cv::AccessFlag flags, cv::UMatUsageFlags usage) const override {
    return cv::Mat::getDefaultAllocator()->allocate(data, flags, usage);
  }
  void deallocate(cv::UMatData* data) const override {
    if (!data) return;
    delete static_cast<Held*>(data->userdata);
    delete data;
  }

  cv::Mat share(const py::array& array, int rows, int columns, int type, std::size_t step) const {
    auto* memory = static_cast<unsigned char*>(const_cast<void*>(array.data()));
    cv::Mat picture(rows, columns, type, memory, step);
    auto* data = new cv::UMatData(this);
    data->data = data->origdata = memory;
    data->size = step * static_cast<std::size_t>(rows);
    data->userdata = new Held(array);
    picture.u = data;
    picture.addref();
    return picture;
  }
};

/// Lives for ever: pictures may outlive the module.
const ArrayKeeper& keeper() {
  static const auto* const kKeeper = new ArrayKeeper;
  return *kKeeper;
}

struct Expected {
  const char* text;
  int type;
  py::ssize_t channels, item;  ///< bytes of a pixel's number
};

Expected expected_of(Pixels pixels) {
  switch (pixels) {
    case Pixels::color:
      return {"uint8 of shape (height, width, 3), in the order blue, green, red", CV_8UC3, 3, 1};
    case Pixels::mask:
      return {"uint8 or bool of shape (height, width)", CV_8UC1, 1, 1};
    case Pixels::depth:
      return {"float32 of shape (height, width), in metres", CV_32FC1, 1, 4};
  }
  throw Error("no such picture");
}

bool has_type(const py::array& array, Pixels pixels) {
  const char kind = array.dtype().kind();
  const bool native = array.dtype().attr("isnative").cast<bool>();
  const py::ssize_t item = array.itemsize();
  if (pixels == Pixels::depth) return kind == 'f' && item == 4 && native;
  return item == 1 && (kind == 'u' || (kind == 'b' && pixels == Pixels::mask));
}

}  // namespace

std::string shape_text(const py::array& array) {
  std::vector<py::ssize_t> shape(array.shape(), array.shape() + array.ndim());
  return fmt::format("({}{})", fmt::join(shape, ", "), shape.size() == 1 ? "," : "");
}

void check_blur(double blur) {
  if (!std::isfinite(blur) || blur < 0)
    throw Error(fmt::format("blur: expected pixels, 0 or more; found {}", blur));
}

cv::Mat picture_of(const py::handle& handle, Pixels pixels, const std::string& what) {
  const Expected expected = expected_of(pixels);
  const auto fail = [&](const std::string& found) {
    throw DataError(
        fmt::format("{}: expected a numpy array of {}; found {}", what, expected.text, found));
  };
  if (!py::isinstance<py::array>(handle))
    fail(py::cast<std::string>(py::type::of(handle).attr("__name__")));
  const auto array = py::reinterpret_borrow<py::array>(handle);
  const bool color = expected.channels == 3;
  if (!has_type(array, pixels) || array.ndim() != (color ? 3 : 2) ||
      (color && array.shape(2) != 3) || array.size() == 0 || array.shape(0) > (1 << 20) ||
      array.shape(1) > (1 << 20))
    fail(fmt::format("{} of shape {}", py::cast<std::string>(py::str(array.dtype())),
                     shape_text(array)));
  const py::ssize_t pixel = expected.channels * expected.item;
  const py::ssize_t step = array.shape(0) == 1 ? pixel * array.shape(1) : array.strides(0);
  if (step < pixel * array.shape(1) || (array.shape(1) > 1 && array.strides(1) != pixel) ||
      (color && array.strides(2) != expected.item) || step % expected.item != 0 ||
      reinterpret_cast<std::uintptr_t>(array.data()) % static_cast<std::size_t>(expected.item) != 0)
    throw DataError(fmt::format(
        "{}: its rows are not contiguous, as those of a flipped or transposed array; pass "
        "numpy.ascontiguousarray(picture)",
        what));
  return keeper().share(array, static_cast<int>(array.shape(0)), static_cast<int>(array.shape(1)),
                        expected.type, static_cast<std::size_t>(step));
}

py::object array_of(const cv::Mat& picture) {
  if (picture.empty()) return py::none();
  auto* kept = new cv::Mat(picture);
  const py::capsule owner(kept, [](void* mat) { delete static_cast<cv::Mat*>(mat); });
  const auto depth = picture.depth();
  const py::dtype type = depth == CV_32F   ? py::dtype::of<float>()
                         : depth == CV_16U ? py::dtype::of<std::uint16_t>()
                                           : py::dtype::of<std::uint8_t>();
  std::vector<py::ssize_t> shape{picture.rows, picture.cols};
  std::vector<py::ssize_t> strides{static_cast<py::ssize_t>(picture.step[0]),
                                   static_cast<py::ssize_t>(picture.elemSize())};
  if (picture.channels() > 1) {
    shape.push_back(picture.channels());
    strides.push_back(static_cast<py::ssize_t>(picture.elemSize1()));
  }
  py::array array(type, shape, strides, picture.data, owner);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

std::string Numbers::problem(const char* what, const std::string& shape) const {
  return fmt::format("{}: expected an array of shape {}; found {}", what, shape, found);
}

Numbers numbers_of(const py::handle& object) {
  Numbers numbers{Numbers::Array::ensure(object)};
  if (numbers.array) {
    numbers.found = shape_text(numbers.array);
    return numbers;
  }
  numbers.found = py::cast<std::string>(py::type::of(object).attr("__name__"));
  try {  // again, because ensure() forgets what numpy says
    py::module_::import("numpy").attr("asarray")(object, "float64");
  } catch (const py::error_already_set& error) {
    numbers.found += ", of which numpy says: " + py::cast<std::string>(py::str(error.value()));
  }
  return numbers;
}

ColumnsMap columns_of(const Numbers& array, Eigen::Index dimension, const char* what) {
  const bool some = array.ndim() == 1 || array.ndim() == 2;
  if (!some || array.shape(array.ndim() - 1) != dimension)
    array.refuse(what, fmt::format("(N, {0}) or ({0},)", dimension));
  return ColumnsMap(array.data(), dimension, array.ndim() == 1 ? 1 : array.shape(0));
}

py::array_t<double> array_of(const Eigen::VectorXd& vector) {
  return py::array_t<double>({static_cast<py::ssize_t>(vector.size())}, vector.data());
}
py::array_t<double> array_of(const std::vector<double>& numbers) {
  return py::array_t<double>({static_cast<py::ssize_t>(numbers.size())}, numbers.data());
}
py::array_t<double> points_of(const Eigen::Matrix3Xd& points) { return rows_of<double>(points); }

Eigen::VectorXd vector_of(const Numbers& array, const char* what) {
  if (array.ndim() != 1) array.refuse(what, "(N,)");
  return Eigen::Map<const Eigen::VectorXd>(array.data(), array.shape(0));
}

Eigen::VectorXd vector_of(const Numbers& array, Eigen::Index size, const char* what) {
  if (array.ndim() != 1 || array.shape(0) != size) array.refuse(what, fmt::format("({},)", size));
  return vector_of(array, what);
}

Eigen::VectorXd finite_vector_of(const Numbers& array, Eigen::Index size, const char* what) {
  Eigen::VectorXd vector = vector_of(array, size, what);
  for (Eigen::Index i = 0; i < size; ++i)
    if (!std::isfinite(vector[i]))
      throw Error(fmt::format("{}: number {} is {}; expected finite numbers", what, i, vector[i]));
  return vector;
}

Eigen::MatrixXd matrix_of(const Numbers& array, Eigen::Index rows, Eigen::Index columns,
                          const char* what) {
  if (array.ndim() != 2 || array.shape(0) != rows || array.shape(1) != columns)
    array.refuse(what, fmt::format("({}, {})", rows, columns));
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return Eigen::Map<const RowMajor>(array.data(), rows, columns);
}

Eigen::Matrix3Xd matrix_of_points(const Numbers& array, const char* what) {
  if (array.ndim() != 2 || array.shape(1) != 3) array.refuse(what, "(N, 3)");
  return Eigen::Map<const Eigen::Matrix3Xd>(array.data(), 3, array.shape(0));
}

}  // namespace hypotrack::python
