// SPDX-License-Identifier: Apache-2.0
#include "learner/blas.h"

#include <dlfcn.h>
#include <torch/version.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <system_error>

#include "proto/system/processors.h"

namespace corridor::learner {
namespace {

// A function without arguments that returns a C string, if some loaded library has it.
std::string call(const char* name) {
  using Function = const char* (*)();
  const auto function = reinterpret_cast<Function>(dlsym(RTLD_DEFAULT, name));
  const char* text = function == nullptr ? nullptr : function();
  return text == nullptr ? std::string() : std::string(text);
}

}  // namespace

void use_portable_kernels(char** argv) {
  static std::optional<std::string> kernels = portable_kernels();  // the environment points there
  if (!kernels) return;
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) return;
  putenv(kernels->data());
  execv(program.c_str(), argv);  // returns on failure: then on with the kernels at hand
}

Blas blas_in_use() {
  Blas blas;
  Dl_info info{};
  void* sgemm = dlsym(RTLD_DEFAULT, "sgemm_");
  if (sgemm != nullptr && dladdr(sgemm, &info) != 0 && info.dli_fname != nullptr) {
    std::error_code error;
    const std::filesystem::path resolved = std::filesystem::canonical(info.dli_fname, error);
    blas.library = error ? info.dli_fname : resolved.string();
  }
  // The symbols may also be those of an OpenBLAS that something else has brought along.
  if (blas.library.find("openblas") != std::string::npos) {
    blas.core = call("openblas_get_corename");
    blas.config = call("openblas_get_config");
  }
  return blas;
}

std::string warning_about(const Blas& blas) {
  // Debian's reference BLAS is .../blas/libblas.so.3.x; a LibTorch with a BLAS inside exports none.
  if (blas.library.find("/blas/libblas.so") == std::string::npos) return {};
  return "the learner computes with the reference BLAS (" + blas.library +
         "), up to 20 times slower than OpenBLAS: apt-get install libopenblas0-serial";
}

std::string libtorch_version() { return TORCH_VERSION; }

}  // namespace corridor::learner
