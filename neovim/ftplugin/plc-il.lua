if vim.b.did_ftplugin then
  return
end
vim.b.did_ftplugin = 1

local set = vim.opt_local
set.commentstring = '// %s'
set.comments = 's1:(*,ex:*),://'
-- Addresses and literals are words: %IX0.0, T#1h30m, D0.3. Comparisons such as LD= are not, because of := in parameters.
set.iskeyword = '@,48-57,_,192-255,%,.,#'
set.expandtab = true
set.shiftwidth = 4
set.softtabstop = 4
set.formatoptions:remove('t')

vim.b.undo_ftplugin = 'setlocal commentstring< comments< iskeyword< expandtab< shiftwidth< softtabstop< formatoptions<'
