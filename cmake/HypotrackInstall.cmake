# Installation and the package that find_package(hypotrack) finds.
