// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// One function per subcommand; it registers the subcommand, its options and its help with the program. The subcommand's
// callback does the work. It throws `lanthorn::Error` on bad input and `CLI::RuntimeError(1)` to exit with 1.
#pragma once

namespace CLI {  // NOLINT(readability-identifier-naming): theirs
class App;
}

namespace lanthorn::program {

void add_render(CLI::App& app);
void add_serve(CLI::App& app);
void add_link(CLI::App& app);
void add_view(CLI::App& app);
void add_ibl(CLI::App& app);
void add_info(CLI::App& app);
void add_compare(CLI::App& app);
void add_convert(CLI::App& app);
void add_converge(CLI::App& app);
void add_denoise(CLI::App& app);
void add_develop(CLI::App& app);
void add_merge(CLI::App& app);
void add_shards(CLI::App& app);
void add_photons(CLI::App& app);
void add_list(CLI::App& app);
void add_manual(CLI::App& app);

}  // namespace lanthorn::program
