#include <cmath>
#include <mutex>

#include "hmi/server/api.hpp"
#include "hmi/server/api_support.hpp"
#include "hmi/server/import_request.hpp"

namespace madori::hmi {
namespace {

using nlohmann::json;

/// The one preview that there is; taken over only while the site is what it was compared with.
class PreviewDesk {
 public:
  void put(std::unique_ptr<DrawingPreview> preview, json site) {
    const std::scoped_lock lock(mutex_);
    preview_ = std::move(preview);
    site_ = std::move(site);
  }
  void clear() { put(nullptr, {}); }
  [[nodiscard]] json report() {
    const std::scoped_lock lock(mutex_);
    return there().report();
  }
  [[nodiscard]] json move(const mapping::Similarity& by, const json& site) {
    const std::scoped_lock lock(mutex_);
    require(site);
    there().move(by);
    return there().report();
  }
  void apply(const json& site) {
    const std::scoped_lock lock(mutex_);
    require(site);
    there().apply();
    preview_ = nullptr;
  }

 private:
  DrawingPreview& there() {
    if (!preview_) throw Error("the new drawing", "is no longer there", "choose its file again");
    return *preview_;
  }
  void require(const json& site) const {
    if (preview_ && site != site_) throw Conflict();
  }

  std::mutex mutex_;
  std::unique_ptr<DrawingPreview> preview_;
  json site_;
};

/// Revisions of what a preview is compared with.
json compared_with(const SiteEditor& editor) {
  json now = editor.revisions();
  now.erase("vehicle");
  return now;
}

mapping::Similarity similarity_from(const json& wire) {
  const mapping::Similarity by{wire.at("scale").get<double>(),
                               wire.at("yaw").get<double>(),
                               {wire.at("x").get<double>(), wire.at("y").get<double>()}};
  constexpr double kFarthest_m = 1e5, kMost = 10.0;
  const bool good = std::isfinite(by.yaw_rad) && by.scale > 1.0 / kMost && by.scale < kMost &&
                    std::abs(by.offset.x()) < kFarthest_m && std::abs(by.offset.y()) < kFarthest_m;
  if (!good) throw Error("the new drawing", "cannot lie there", "move it onto the old one");
  return by;
}

Response start_preview(ApiContext& context, const std::shared_ptr<PreviewDesk>& desk,
                       const Request& request) {
  const UploadedDrawing drawing = uploaded_drawing(context, request);
  const bool started = context.job.start("preview", [drawing, desk, &context](const Job::Progress& progress) {
    json site = compared_with(context.editor);
    desk->put(drawing.read([&](const auto& options) { return context.preview_drawing(options, progress); }),
              std::move(site));
    return Job::Outcome{"", nullptr};
  });
  if (!started) return Response::error(409, "busy", "another drawing is being imported");
  return answer(context.job.state());
}

}  // namespace

void add_preview_routes(Router& router, ApiContext& context) {
  const auto desk = std::make_shared<PreviewDesk>();
  const std::string address = "/api/site/drawing/preview";
  router.add("POST", address, Role::Integrator, guarded([&context, desk](const Request& request) {
               return start_preview(context, desk, request);
             }),
             Work::Upload);
  router.add("GET", address, Role::Integrator, answering([desk](const Request&) { return desk->report(); }),
             Work::Worker);
  router.add("DELETE", address, Role::Integrator, answering([desk](const Request&) {
               desk->clear();
               return json::object();
             }),
             Work::Worker);
  router.add("POST", address + "/move", Role::Integrator, answering([&context, desk](const Request& request) {
               return desk->move(similarity_from(body_of(request)), compared_with(context.editor));
             }),
             Work::Worker);
  router.add("POST", address + "/apply", Role::Integrator,
             changing(context.vehicle,
                      [&context, desk](const Request&) {
                        desk->apply(compared_with(context.editor));
                        return json::object();
                      }),
             Work::Worker);
}

}  // namespace madori::hmi
