//! What the client says about its folders, files and settings while the server runs.

use super::projects::{canonical, file_path};
use super::settings::Settings;
use super::workspace::{State, Workspace};
use crate::project::MANIFEST_NAME;
use serde_json::Value;
use std::path::PathBuf;
use std::sync::Arc;
use tower_lsp::ls_types::{
    ConfigurationItem, DidChangeConfigurationParams, DidChangeWatchedFilesParams,
    DidChangeWorkspaceFoldersParams, InitializeParams, Uri, WorkspaceFolder,
};

/// The section of the client's configuration that is the server's.
const SECTION: &str = "rungwise";

impl Workspace {
    /// Takes the folders with which the client starts.
    pub(super) fn take_folders(&self, state: &mut State, params: &InitializeParams) {
        #[allow(deprecated, reason = "older clients send it instead of folders")]
        let root = params.root_uri.clone();
        let folders = match &params.workspace_folders {
            Some(folders) => folders.iter().map(|folder| folder.uri.clone()).collect(),
            None => Vec::from_iter(root),
        };
        folders.into_iter().for_each(|uri| state.add_folder(uri));
    }

    pub(super) fn change_folders(&self, params: DidChangeWorkspaceFoldersParams) {
        let mut state = self.state();
        for WorkspaceFolder { uri, .. } in params.event.removed {
            state.remove_folder(&uri);
        }
        params.event.added.into_iter().for_each(|folder| state.add_folder(folder.uri));
    }

    /// Files changed on the disk: manifests are read at once, program files in the background.
    pub(super) fn change_files(&self, params: DidChangeWatchedFilesParams) {
        let paths: Vec<PathBuf> = params.changes.iter().filter_map(|change| file_path(&change.uri)).collect();
        let is_manifest = |path: &&PathBuf| path.file_name().is_some_and(|name| name == MANIFEST_NAME);
        // A client that does not say which files changed may mean any.
        if params.changes.is_empty() || paths.iter().any(|path| is_manifest(&path)) {
            self.reread_projects();
        }
        // The disk is asked before the state is locked.
        let roots = paths.iter().filter(|path| is_manifest(path)).filter_map(|path| path.parent());
        let roots: Vec<_> = roots.map(|root| (canonical(root), root.to_path_buf())).collect();
        let paths: Vec<_> = paths.iter().map(|path| canonical(path)).collect();
        let state = self.state();
        let Some(keeper) = &state.keeper else { return };
        roots.into_iter().for_each(|(key, root)| keeper.read(key, root));
        for (key, loaded) in state.snapshot.projects.iter() {
            if paths.iter().any(|path| path.starts_with(key)) {
                keeper.read(key.clone(), loaded.root.clone());
            }
        }
    }

    /// Looks for changes on the disk around a document, for clients that do not watch files.
    pub(super) fn look_around(&self, uri: &Uri) {
        let state = self.state();
        let (Some(keeper), false) = (&state.keeper, state.requests.watch) else { return };
        let project = state.snapshot.open(uri).and_then(|open| open.project.clone());
        if let Some((key, loaded)) = project.and_then(|key| state.snapshot.projects.get_key_value(&key)) {
            keeper.read(key.clone(), loaded.root.clone());
        }
    }

    pub(super) fn configure(self: &Arc<Workspace>, params: &DidChangeConfigurationParams) {
        // Clients that can be asked send nothing of use along.
        if self.requests().configuration {
            self.ask_configuration();
        } else {
            self.take_settings(&params.settings);
        }
    }

    /// Asks the client for its settings; they are in force as soon as it answers.
    pub(super) fn ask_configuration(self: &Arc<Workspace>) {
        let workspace = self.clone();
        tokio::spawn(async move {
            let item = ConfigurationItem { scope_uri: None, section: Some(SECTION.to_string()) };
            match workspace.client.configuration(vec![item]).await {
                Ok(answer) => answer.iter().for_each(|settings| workspace.take_settings(settings)),
                Err(reason) => tracing::warn!("the client does not tell its settings: {reason}"),
            }
        });
    }

    /// Puts settings in force. A client without settings says so with `null`; what was said before stays in force.
    fn take_settings(&self, value: &Value) {
        let Some(settings) = Settings::read(Some(value)) else { return };
        {
            let mut state = self.state();
            if state.settings_source.as_ref() == Some(value) {
                return;
            }
            state.settings_source = Some(value.clone());
            state.snapshot.manner.language = settings.language(state.speech);
            state.snapshot.settings = Arc::new(settings);
        }
        self.reread_projects();
        // The language, and what is shown at all, are not in the text that a client may have asked about.
        self.refresh();
    }
}

impl State {
    fn add_folder(&mut self, uri: Uri) {
        let Some(path) = file_path(&uri) else { return };
        if let Some(keeper) = &self.keeper {
            keeper.search(path.clone());
        }
        self.folders.push((uri, path));
    }

    /// Projects of the folder are forgotten unless a document of theirs is open or another folder has them.
    fn remove_folder(&mut self, uri: &Uri) {
        let Some(place) = self.folders.iter().position(|(folder, _)| folder == uri) else { return };
        self.folders.remove(place);
        let kept: Vec<_> = self.folders.iter().map(|(_, path)| canonical(path)).collect();
        let Some(keeper) = &self.keeper else { return };
        for key in self.snapshot.projects.keys() {
            let is_kept = kept.iter().any(|folder| key.starts_with(folder));
            if !is_kept && self.snapshot.opens_of(key).is_empty() {
                keeper.forget(key.clone());
            }
        }
    }
}
