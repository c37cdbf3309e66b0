//! The list of all routes, and the middleware of every request.

use super::operations::docs::OpenApiPage;
use super::{
    App, access, describe, leg_tables, legs, observe, operations, origin, page, plans, protect,
    slews, spacecraft, studies, verify,
};
use crate::documents::jobs::EventDocument;
use crate::documents::leg_table_jobs::LegTableEventDocument;
use crate::jobs::Jobs;
use axum::middleware::{from_fn, from_fn_with_state};
use axum::routing::get;
use axum::{Extension, Router};
use tower_http::CompressionLevel;
use tower_http::catch_panic::CatchPanicLayer;
use tower_http::compression::CompressionLayer;
use utoipa::OpenApi;
use utoipa_axum::router::{OpenApiRouter, UtoipaMethodRouterExt as _};
use utoipa_axum::routes;
use utoipa_swagger_ui::SwaggerUi;

/// Head of the OpenAPI description.
#[derive(OpenApi)]
#[openapi(
    info(
        title = "slewplan",
        description = "Minimum-time multi-target attitude scheduling for spacecraft with reaction \
            wheels.\n\nNumbers are SI with the unit in the field name. Unknown fields are \
            refused. Every error is RFC 9457 problem details; `/docs/errors` lists the codes.",
    ),
    components(schemas(EventDocument, LegTableEventDocument)),
    tags(
        (name = "plans", description = "Planning jobs"),
        (name = "legs", description = "Leg times"),
        (name = "slews", description = "Single slews with a choice of objective and command"),
        (name = "studies", description = "Effects of options, and envelopes of wheels"),
        (name = "spacecraft", description = "Stored spacecraft"),
        (name = "verify", description = "Independent verification"),
        (name = "operations", description = "Running the service"),
    ),
)]
struct InterfaceDescription;

fn routes() -> OpenApiRouter<App> {
    OpenApiRouter::with_openapi(InterfaceDescription::openapi())
        .routes(routes!(plans::create::handler, plans::list::handler))
        .routes(routes!(plans::get::handler, plans::delete::handler))
        .routes(routes!(plans::scenario::handler))
        .routes(routes!(plans::result::handler))
        .routes(routes!(plans::events::handler))
        .routes(routes!(plans::stop::handler))
        .routes(routes!(plans::cancel::handler))
        .routes(routes!(legs::query::handler).layer(gzip()))
        .routes(routes!(
            leg_tables::create::handler,
            leg_tables::list::handler
        ))
        .routes(routes!(
            leg_tables::get::handler,
            leg_tables::delete::handler
        ))
        .routes(routes!(leg_tables::result::handler).layer(gzip()))
        .routes(routes!(leg_tables::events::handler))
        .routes(routes!(leg_tables::stop::handler))
        .routes(routes!(leg_tables::cancel::handler))
        .routes(routes!(legs::list::handler))
        .routes(routes!(legs::import::handler))
        .routes(routes!(legs::get::handler))
        .routes(routes!(slews::handler))
        .routes(routes!(studies::authority::handler))
        .routes(routes!(studies::envelopes::handler))
        .routes(routes!(studies::comparison::handler))
        .routes(routes!(studies::flight::handler))
        .routes(routes!(spacecraft::list::handler))
        .routes(routes!(spacecraft::put::handler, spacecraft::get::handler))
        .routes(routes!(verify::handler))
        .routes(routes!(page::handler))
        .routes(routes!(operations::limits::handler))
        .routes(routes!(operations::version::handler))
        .routes(routes!(operations::docs::openapi))
        .routes(routes!(operations::docs::errors))
        .routes(routes!(operations::health::live))
        .routes(routes!(operations::health::ready))
        .routes(routes!(operations::metrics::handler))
}

/// Compression of large answers and of the page, where `Accept-Encoding` asks for it.
fn gzip() -> CompressionLayer {
    CompressionLayer::new().quality(CompressionLevel::Fastest)
}

/// The whole service.
pub(crate) fn router(app: App) -> Router {
    let (router, description) = routes().split_for_parts();
    let docs = SwaggerUi::new("/docs")
        .config(utoipa_swagger_ui::Config::from("/openapi.yaml").default_model_rendering("model"));
    let router = router
        .merge(docs)
        .route(page::FILES, get(page::file).layer(gzip()));
    #[cfg(feature = "faults")]
    let router = router.layer(from_fn(observe::fault));
    router
        .layer(from_fn_with_state(app.clone(), access::authorize))
        .layer(from_fn_with_state(app.clone(), origin::guard))
        .layer(CatchPanicLayer::custom(observe::panicked))
        .layer(from_fn(observe::envelop))
        .layer(from_fn_with_state(app.clone(), observe::observe))
        .layer(from_fn(protect::protect))
        .layer(Extension(OpenApiPage::new(describe::yaml(&description))))
        .with_state(app)
}

/// What a process answers that only solves.
pub(crate) fn worker_router(jobs: Jobs) -> Router {
    Router::new()
        .route("/metrics", get(operations::metrics::of_worker))
        .route("/health/live", get(operations::health::live))
        .route("/health/ready", get(operations::health::worker_ready))
        .layer(from_fn(observe::envelop))
        .layer(from_fn(protect::protect))
        .with_state(jobs)
}

/// The description of the interface as YAML.
pub(crate) fn openapi() -> String {
    describe::yaml(&routes().into_openapi())
}
