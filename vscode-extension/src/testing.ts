/** Scenario tests as the server lists and runs them. Pure. */

import type { PlainRange } from './structuralEdits';

/** The commands of the server. */
export const LIST = 'rungwise.test.list';
export const RUN = 'rungwise.test.run';

export interface Problem {
  readonly uri: string;
  readonly range: PlainRange;
  readonly message: string;
}

/** A file with scenarios. */
export interface SuiteFile {
  readonly uri: string;
  readonly scenarios: readonly { readonly name: string; readonly range: PlainRange }[];
  readonly problems: readonly Problem[];
}

export interface Failure {
  readonly message: string;
  readonly range: PlainRange;
}

export interface ScenarioResult {
  readonly name: string;
  readonly passed: boolean;
  readonly failures: readonly Failure[];
  /** The timing picture up to the place of the difference. */
  readonly picture?: string;
}

export interface Contact {
  readonly name: string;
  readonly range: PlainRange;
  readonly on: number;
  readonly off: number;
}

export interface Rung {
  readonly range: PlainRange;
  readonly evaluated: number;
  readonly contacts: readonly Contact[];
}

/** What came of a file. */
export interface SuiteResult {
  readonly uri: string;
  readonly problems: readonly Problem[];
  readonly scenarios: readonly ScenarioResult[];
  readonly golden: readonly { readonly uri: string; readonly text: string }[];
  readonly coverage: readonly { readonly uri: string; readonly rungs: readonly Rung[] }[];
}

/** The files of an answer to {@link LIST}. */
export function listed(answer: unknown): SuiteFile[] {
  return filesOf<SuiteFile>(answer).map((file) => ({
    ...file,
    scenarios: list(file.scenarios),
    problems: list(file.problems),
  }));
}

/** The files of an answer to {@link RUN}. */
export function results(answer: unknown): SuiteResult[] {
  return filesOf<SuiteResult>(answer).map((file) => ({
    ...file,
    problems: list(file.problems),
    scenarios: list(file.scenarios),
    golden: list(file.golden),
    coverage: list(file.coverage),
  }));
}

function filesOf<File extends { uri: string }>(answer: unknown): File[] {
  const files = (answer as { files?: unknown } | null)?.files;
  return list<File>(files).filter((file) => typeof file?.uri === 'string');
}

function list<Item>(value: unknown): Item[] {
  return Array.isArray(value) ? (value as Item[]) : [];
}

/** What several files have seen of the same program, added up. */
export class Covered {
  private readonly programs = new Map<string, Rung[]>();

  add({ coverage }: SuiteResult): void {
    for (const { uri, rungs } of coverage) {
      const known = this.programs.get(uri);
      this.programs.set(uri, known === undefined ? [...rungs] : known.map((rung, at) => sum(rung, rungs[at])));
    }
  }

  files(): { uri: string; rungs: Rung[] }[] {
    return [...this.programs].map(([uri, rungs]) => ({ uri, rungs }));
  }
}

function sum(left: Rung, right: Rung | undefined): Rung {
  if (right === undefined) {
    return left;
  }
  return {
    range: left.range,
    evaluated: left.evaluated + right.evaluated,
    contacts: left.contacts.map((contact, at) => ({
      ...contact,
      on: contact.on + (right.contacts[at]?.on ?? 0),
      off: contact.off + (right.contacts[at]?.off ?? 0),
    })),
  };
}

/** The name of a new file: the first of `motor.test.toml`, `motor-2.test.toml`, … that is not taken. */
export async function freeName(name: string, isTaken: (name: string) => Promise<boolean>): Promise<string> {
  const stem = name.replace(/\.test\.toml$/, '');
  for (let number = 1; ; number += 1) {
    const free = number === 1 ? name : `${stem}-${number}.test.toml`;
    if (!(await isTaken(free))) {
      return free;
    }
  }
}
