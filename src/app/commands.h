#pragma once

#include "app/options.h"

namespace mote {

/// The commands, one file each. They return normally when all is done and throw Error otherwise.
void run_render(const RenderOptions& options);
void run_check(const CheckOptions& options);
void run_info(const InfoOptions& options);
void run_cache(const CacheOptions& options);
void run_sheet(const SheetOptions& options);
/// Throws Error(BiasFound) when a figure is over its threshold, after writing the files asked for.
void run_compare(const CompareOptions& options);
void run_bench(const BenchOptions& options);
/// Throws Error(BiasFound) or Error(NotEnoughRuns) after writing the files asked for.
void run_verify(const VerifyOptions& options);
void run_schema(const SchemaOptions& options);
void run_version(const VersionOptions& options);

}  // namespace mote
