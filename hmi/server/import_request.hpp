#pragma once

#include <memory>
#include <string>

#include "core/result.hpp"
#include "hmi/server/api.hpp"
#include "hmi/server/uploaded_file.hpp"
#include "mapping/drawing/import_drawing.hpp"

namespace madori::hmi {

/// A drawing that was sent, with what is to be done with it (ImportOptions of hmi/schema).
struct UploadedDrawing {
  mapping::ImportOptions options;
  std::shared_ptr<const UploadedFile> file;
  std::string shown;  ///< the name that the operator knows it by

  /// What `work` makes of the options; an Error becomes one of a kind that panels know.
  template <class Read>
  auto read(Read work) const {
    try {
      return work(options);
    } catch (const Error& e) {
      throw failure(e.what());
    }
  }

  [[nodiscard]] Job::Failed failure(const std::string& reason) const;
};

/// Throws Error on options that make no sense, and where the disk is full.
[[nodiscard]] UploadedDrawing uploaded_drawing(ApiContext& context, const Request& request);

}  // namespace madori::hmi
