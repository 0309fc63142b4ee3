#pragma once

/// Marks every body of an inline namespace `internal` in a header: libhypotrack.so and
/// libhypotrack_lab.so export what it declares to the programs and tests of the project. The
/// symbols have `internal` in their names, so that none is bound to one of a plugin or of a public
/// header. A class is as visible as its first declaration says. Sources open `hypotrack::internal`
/// without the mark: what they alone declare is hidden.
#define HYPOTRACK_EXPORTED [[gnu::visibility("default")]]
