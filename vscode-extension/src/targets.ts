/** The list from which the target PLC is picked. */

export interface TargetChoice {
  /** Value of the setting `rungwise.target`. */
  readonly value: string;
  readonly label: string;
  readonly description: string;
}

const CHOICES: readonly TargetChoice[] = [
  { value: 'auto', label: 'Automatic', description: 'from rungwise.toml, else from the program' },
  { value: 'fx1s', label: 'FX1S', description: '2,000 steps' },
  { value: 'fx1n', label: 'FX1N', description: '8,000 steps' },
  { value: 'fx2n', label: 'FX2N', description: '8,000 steps, 16,000 with a memory cassette' },
  { value: 'fx3u', label: 'FX3U', description: '64,000 steps' },
  { value: 'iec', label: 'IEC 61131-3', description: 'no particular PLC' },
];

/** All choices; the one in force is marked, so that the list says where one stands. */
export function targetChoices(current: string | null, used: string | undefined): TargetChoice[] {
  const chosen = current ?? 'auto';
  return CHOICES.map((choice) => {
    if (choice.value === chosen) {
      const now = chosen === 'auto' && used ? `: ${used.toUpperCase()}` : '';
      return { ...choice, description: `${choice.description} (selected${now})` };
    }
    return choice;
  });
}
