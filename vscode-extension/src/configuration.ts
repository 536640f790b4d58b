/** Reads the settings of the window. */

import * as vscode from 'vscode';
import { readServerSettings, serverArguments, type ServerSettings } from './settings';

const SECTION = 'rungwise';

/** The settings of the window as the server gets them. */
export function currentSettings(): ServerSettings {
  const section = vscode.workspace.getConfiguration(SECTION);
  return readServerSettings((name) => section.get(name));
}

/** Path of the server as the user wrote it; blank when unset. */
export function serverPathSetting(): string {
  return vscode.workspace.getConfiguration(SECTION).get('server.path', '');
}

/** Arguments of the server process. */
export function currentServerArguments(): string[] {
  return serverArguments(vscode.workspace.getConfiguration(SECTION).get('server.extraArgs'));
}
