--- Keys of a ladder buffer: `<Plug>` names for everything, default keys below <localleader>, and the text objects.
local client = require('rungwise.client')
local t = require('rungwise.words').t
local M = {}

--- Name of the mapping of an edit.
function M.plug(name)
  return ('<Plug>(rungwise-%s)'):format(name)
end

--- Defines the `<Plug>` names, once, for every buffer.
function M.define()
  for name, edit in pairs(require('rungwise.edit').edits) do
    vim.keymap.set({ 'n', 'x' }, M.plug(name), function()
      require('rungwise.edit').run(name)
    end, { desc = 'Rungwise: ' .. t(edit[3]) })
  end
  for letter, object in pairs(require('rungwise.textobjects').objects) do
    for _, around in ipairs({ false, true }) do
      local name = (around and 'a' or 'i') .. '-' .. object
      vim.keymap.set({ 'o', 'x' }, M.plug(name), function()
        require('rungwise.textobjects').select(object, around)
      end, { desc = 'Rungwise: ' .. t(around and 'around %s' or 'inner %s', t(object)) })
    end
  end
end

--- Maps the default keys in a buffer, except those that the user mapped by hand. Answers the commands that undo it.
function M.attach(buffer)
  if client.options().mappings == false then
    return ''
  end
  local undo = {}
  local function map(modes, key, plug, description)
    if vim.fn.hasmapto(plug, modes[1]) == 0 then
      vim.keymap.set(modes, key, plug, { buffer = buffer, remap = true, desc = description })
      for _, mode in ipairs(modes) do
        table.insert(undo, ('silent! execute "%sunmap <buffer> %s"'):format(mode, key:gsub('<', '\\<')))
      end
    end
  end
  for name, edit in pairs(require('rungwise.edit').edits) do
    map({ 'n', 'x' }, '<LocalLeader>' .. edit[2], M.plug(name), t(edit[3]))
  end
  for letter, object in pairs(require('rungwise.textobjects').objects) do
    map({ 'o', 'x' }, 'i' .. letter, M.plug('i-' .. object), t('inner %s', t(object)))
    map({ 'o', 'x' }, 'a' .. letter, M.plug('a-' .. object), t('around %s', t(object)))
  end
  return table.concat(undo, ' | ')
end

return M
