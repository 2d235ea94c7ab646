//! The last model and the last message of `enmm edit`, and the answers to its page.

use std::path::Path;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use enmm_report::{Answer, Source, edit_page};
use serde_json::json;

/// Things that the page shows.
#[derive(Debug, Clone, Default)]
pub struct View {
    /// Counts every change.
    pub state: u64,
    /// Counts the models that could be built.
    pub model: u64,
    /// Name of the case.
    pub title: String,
    /// Line about the last model.
    pub message: String,
    /// Error of the last save, if there is one: the model is then that of an earlier save.
    pub error: Option<String>,
    /// Names and values of the last model.
    pub facts: Vec<(String, String)>,
    /// Notes and warnings of the last model.
    pub notes: Vec<String>,
    /// Page of the last model.
    pub page: Option<Arc<[u8]>>,
    /// Stereonet of the last model, if it has a face.
    pub net: Option<Arc<[u8]>>,
}

/// The view that the build changes and the server reads.
pub struct Shown(Mutex<View>);

impl Shown {
    /// A view of nothing yet.
    pub fn new(case: &Path) -> Self {
        let title = case.file_name().unwrap_or_default().to_string_lossy().into_owned();
        Self(Mutex::new(View { title, message: "building …".to_owned(), ..View::default() }))
    }

    /// Changes the view.
    pub fn change(&self, change: impl FnOnce(&mut View)) {
        let mut view = self.view();
        change(&mut view);
        view.state += 1;
    }

    fn view(&self) -> MutexGuard<'_, View> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Source for Shown {
    fn answer(&self, path: &str, from: Option<u64>) -> Answer {
        let view = self.view();
        let whole = |kind, bytes: &Option<Arc<[u8]>>| match bytes {
            Some(bytes) => Answer::whole(kind, Arc::clone(bytes)),
            None => Answer::NOT_FOUND,
        };
        match (path, from) {
            ("/", None) => Answer::whole("text/html; charset=utf-8", edit_page()),
            ("/state", Some(_)) => {
                let state = json!({
                    "state": view.state,
                    "model": view.model,
                    "title": view.title,
                    "message": view.message,
                    "error": view.error,
                    "facts": view.facts,
                    "notes": view.notes,
                    "net": view.net.is_some(),
                });
                Answer::whole("application/json", state.to_string())
            }
            ("/model", Some(_)) => whole("text/html; charset=utf-8", &view.page),
            ("/stereonet.svg", Some(_)) => whole("image/svg+xml", &view.net),
            _ => Answer::NOT_FOUND,
        }
    }
}
