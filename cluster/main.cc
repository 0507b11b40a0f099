// SPDX-License-Identifier: Apache-2.0
// The user's command: starts, watches and stops the other programs, which lie beside it.

#include "cluster/commands.h"
#include "proto/system/program.h"

int main(int argc, char** argv) {
  return corridor::run_program("corridor",
                               [&] { return corridor::cluster::run_command(argc, argv); });
}
