#include "failure_text.hpp"

#include <exception>
#include <new>
#include <system_error>

#include "base/system_problem.hpp"
#include "hypotrack/error.hpp"

namespace hypotrack::app {

std::string failure_text() {
  try {
    throw;
  } catch (const Error& e) {
    return with_advice(e.what());
  } catch (const std::bad_alloc&) {
    return "out of memory";
  } catch (const std::system_error& e) {  // a full disk behind stdout
    return described(e);
  } catch (const std::exception& e) {
    return "unexpected error: " + with_advice(e.what());
  } catch (...) {
    return "unexpected error: a plugin threw something that is no std::exception";
  }
}

}  // namespace hypotrack::app
