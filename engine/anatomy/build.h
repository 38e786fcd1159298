// From a spec to an AnatomyModel.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "anatomy/model.h"
#include "anatomy/spec.h"
#include "core/parallel.h"

namespace cathlab {

/// fraction in [0, 1] of the whole build, and what is being done.
using BuildProgress = std::function<void(double fraction, std::string_view what)>;

/// Version of the builder: goes into content hashes, so that a new builder never takes an old one's cache.
inline constexpr std::uint64_t anatomy_builder_version = 3;

/// Builds the parametric tree.  The same bits on any number of threads.  Throws UserError for a spec that cannot be
/// built: everything that validate() refuses, vessels that touch away from their branch, a lumen too narrow for the
/// voxel, a face_count that cannot give edges_round.
AnatomyModel build_anatomy(const AnatomySpec& spec, const Workers& workers = Workers(1),
                           const BuildProgress& progress = {});

/// Builds a model round an imported mesh.  Throws UserError for an unreadable, empty, open or non-manifold mesh.
AnatomyModel import_anatomy(const ImportedAnatomySpec& spec, const Workers& workers = Workers(1),
                            const BuildProgress& progress = {});

/// The same, kept in a file of cache_folder (created where missing; "" = no cache) by content hash.  A damaged or
/// foreign file is built anew; one that cannot be written is only not kept.
AnatomyModel load_or_build(const AnatomySpec& spec, const std::string& cache_folder,
                           const Workers& workers = Workers(1), const BuildProgress& progress = {});
AnatomyModel load_or_build(const ImportedAnatomySpec& spec, const std::string& cache_folder,
                           const Workers& workers = Workers(1), const BuildProgress& progress = {});

/// Hash of everything in a model.
std::uint64_t model_hash(const AnatomyModel& model);

}  // namespace cathlab
