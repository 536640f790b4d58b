/** The list from which the target PLC is picked. */

import { t } from './words';

export interface TargetChoice {
  /** Value of the setting `rungwise.target`. */
  readonly value: string;
  readonly label: string;
  readonly description: string;
}

/** Made when it is asked for: words have no language before the extension is active. */
const choices = (): TargetChoice[] => [
  { value: 'auto', label: t('Automatic'), description: t('from rungwise.toml, else from the program') },
  { value: 'fx1s', label: 'FX1S', description: t('{0} steps', '2,000') },
  { value: 'fx1n', label: 'FX1N', description: t('{0} steps', '8,000') },
  { value: 'fx2n', label: 'FX2N', description: t('8,000 steps, 16,000 with a memory cassette') },
  { value: 'fx3u', label: 'FX3U', description: t('{0} steps', '64,000') },
  { value: 'iec', label: 'IEC 61131-3', description: t('no particular PLC') },
];

/** All choices; the one in force is marked, so that the list says where one stands. */
export function targetChoices(current: string | null, used: string | undefined): TargetChoice[] {
  const chosen = current ?? 'auto';
  return choices().map((choice) => {
    if (choice.value === chosen) {
      const now = chosen === 'auto' && used ? `: ${used.toUpperCase()}` : '';
      return { ...choice, description: t('{0} (selected{1})', choice.description, now) };
    }
    return choice;
  });
}
