--- Debugging with nvim-dap, where that is installed: its adapter, and a configuration for programs.
local client = require('rungwise.client')
local words = require('rungwise.words')
local t = words.t
local M = {}

--- What starts the debug adapter, as `dap.adapters` takes it.
function M.adapter()
  local language = words.language()
  return {
    type = 'executable',
    command = client.server(),
    args = vim.list_extend({ 'dap' }, language and { '--lang', language } or {}),
    options = { source_filetype = 'ladder' },
  }
end

--- The program of the buffer, stopped at its first instruction.
function M.configuration()
  return {
    type = 'rungwise', request = 'launch', name = t('Rungwise: debug this program'),
    program = '${file}', stopOnEntry = true,
  }
end

--- Tells nvim-dap of the adapter; what the user has configured stays. Gives whether nvim-dap is there.
function M.setup()
  local found, dap = pcall(require, 'dap')
  if not found then
    return false
  end
  dap.adapters.rungwise = dap.adapters.rungwise or function(callback)
    -- Looked for when it is needed: the options may have changed.
    callback(M.adapter())
  end
  for _, filetype in ipairs(client.filetypes) do
    local own = dap.configurations[filetype] or {}
    local is_known = vim.iter(own):any(function(configuration)
      return configuration.type == 'rungwise'
    end)
    if not is_known then
      table.insert(own, M.configuration())
    end
    dap.configurations[filetype] = own
  end
  return true
end

return M
