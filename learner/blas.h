// SPDX-License-Identifier: Apache-2.0
// Which BLAS this process computes with: the learner itself on the CPU, and Debian's LibTorch. It
// decides the speed (Debian's default is up to 20 times slower) and the bits of the result, so it
// is recorded beside each run.
#pragma once

#include <string>

namespace corridor::learner {

// Starts the program anew with portable_kernels (proto/system/processors.h), unless its starter has
// seen to them already: to load it takes a second. Call it first of all in main.
void use_portable_kernels(char** argv);

struct Blas {
  std::string library;  // resolved path of the file that sgemm comes from
  std::string core;     // OpenBLAS's kernel ("SkylakeX"), empty for others
  std::string config;   // OpenBLAS's version and options, empty for others
};

Blas blas_in_use();

// What is wrong with it and what to do, in one line; empty when nothing is.
std::string warning_about(const Blas& blas);

std::string libtorch_version();

}  // namespace corridor::learner
