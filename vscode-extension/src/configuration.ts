/** Reads the settings of the window. */

import * as vscode from 'vscode';
import { readServerSettings, serverArguments, type ServerSettings } from './settings';

const SECTION = 'rungwise';

/**
 * The settings of the window as the server gets them.
 *
 * Only what the user set is sent: a default of package.json would override what `rungwise.toml` says.
 */
export function currentSettings(): ServerSettings {
  const section = vscode.workspace.getConfiguration(SECTION);
  return readServerSettings((name) => {
    const places = section.inspect(name);
    return places?.workspaceFolderValue ?? places?.workspaceValue ?? places?.globalValue;
  });
}

/** Path of the server as the user wrote it; blank when unset. */
export function serverPathSetting(): string {
  return vscode.workspace.getConfiguration(SECTION).get('server.path', '');
}

/** Arguments of the server process. */
export function currentServerArguments(): string[] {
  return serverArguments(vscode.workspace.getConfiguration(SECTION).get('server.extraArgs'));
}

/** Language of messages and pages as the command line takes it: `en` or `zh-CN`. */
export function currentLanguage(): string {
  const chosen = vscode.workspace.getConfiguration(SECTION).get('language', 'auto');
  const language = chosen === 'auto' ? vscode.env.language : chosen;
  return language.toLowerCase().startsWith('zh') ? 'zh-CN' : 'en';
}
